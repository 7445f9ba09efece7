// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SharedLibraryFile.h"

#include <QCoreApplication>
#include <QFile>

#include <algorithm>
#include <cstring>
#include <elf.h>

namespace desktop
{
namespace
{

QString tr(const char* text)
{
  return QCoreApplication::translate("SharedLibraryFile", text);
}

#if defined(__x86_64__)
constexpr Elf64_Half machine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half machine = EM_AARCH64;
#else
#error "Which ELF machine is this?"
#endif

// How far into the file its headers reach. Tables are counted in 64 bits: entries times size cannot overflow there, an offset plus it can.
quint64 promisedSize(const Elf64_Ehdr& header, const QByteArray& segments)
{
  const auto end = [](quint64 offset, quint64 size) { return offset + size < offset ? ~quint64(0) : offset + size; };
  quint64 size = end(header.e_shoff, quint64(header.e_shnum) * header.e_shentsize);
  for (int i = 0; i < header.e_phnum; ++i)
  {
    Elf64_Phdr segment;
    std::memcpy(&segment, segments.constData() + size_t(i) * sizeof segment, sizeof segment);
    size = std::max(size, end(segment.p_offset, segment.p_filesz));
  }
  return size;
}

}  // namespace

QString sharedLibraryProblem(const QString& path)
{
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly))
  {
    return tr("it cannot be read: %1").arg(file.errorString());
  }
  const QByteArray start = file.read(sizeof(Elf64_Ehdr));
  if (!start.startsWith(QByteArray(ELFMAG, SELFMAG)))
  {
    return tr("it is not a shared library: an ELF file begins in another way");
  }
  const QString cutShort = tr("it is cut short: its headers promise %1 bytes, it has %2");
  if (start.size() < int(sizeof(Elf64_Ehdr)))
  {
    return cutShort.arg(sizeof(Elf64_Ehdr)).arg(file.size());
  }
  Elf64_Ehdr header;
  std::memcpy(&header, start.constData(), sizeof header);
  if (header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_ident[EI_DATA] != ELFDATA2LSB || header.e_machine != machine)
  {
    return tr("it was built for another kind of machine");
  }
  if (header.e_type != ET_DYN || header.e_phnum == 0 || header.e_phentsize != sizeof(Elf64_Phdr))
  {
    return tr("it is not a shared library, though an ELF file");
  }
  const int tableSize = header.e_phnum * int(sizeof(Elf64_Phdr));
  const QByteArray segments = file.seek(qint64(header.e_phoff)) ? file.read(tableSize) : QByteArray();
  if (segments.size() < tableSize)
  {
    return cutShort.arg(header.e_phoff + quint64(tableSize)).arg(file.size());
  }
  const quint64 promised = promisedSize(header, segments);
  return promised > quint64(file.size()) ? cutShort.arg(promised).arg(file.size()) : QString();
}

}  // namespace desktop
