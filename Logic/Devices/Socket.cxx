// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

namespace handeye::devices
{

namespace
{

constexpr int BufferBytes = 8 << 20;  // more than a frame of full HD; the kernel takes what it allows

std::string reason(int error)
{
  return std::generic_category().message(error);
}

enum class Waited
{
  Ready,
  TimedOut,
  Woken
};

Waited waitFor(int descriptor, short events, double timeoutSec, const WakeUp& wakeUp)
{
  pollfd ends[2] = { { descriptor, events, 0 }, { wakeUp.descriptor(), POLLIN, 0 } };
  const int count = poll(ends, 2, int(std::max(0.0, timeoutSec) * 1000 + 0.5));
  if (count < 0 && errno != EINTR)
  {
    throw ConnectionError("waiting failed (" + reason(errno) + ")");
  }
  if (count > 0 && ends[1].revents != 0)
  {
    return Waited::Woken;
  }
  return count > 0 && ends[0].revents != 0 ? Waited::Ready : Waited::TimedOut;
}

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses resolve(const std::string& host, int port, bool isPassive)
{
  if (port < 0 || port > 65535)
  {
    throw std::invalid_argument("port " + std::to_string(port) + ": a number from 1 to 65535 is expected");
  }
  addrinfo hints = {};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = isPassive ? AI_PASSIVE : 0;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0)
  {
    throw ConnectionError("'" + host + "' is not a computer that can be found (" + gai_strerror(error) + ")");
  }
  return { found, &freeaddrinfo };
}

void tune(int descriptor)
{
  const int on = 1, size = BufferBytes;
  setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  // Who is gone without a word (cable, power) is noticed after 2 + 3 * 1 s; the system's own answer is two hours.
  const int idleSec = 2, intervalSec = 1, probes = 3;
  setsockopt(descriptor, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof(on));
  setsockopt(descriptor, IPPROTO_TCP, TCP_KEEPIDLE, &idleSec, sizeof(idleSec));
  setsockopt(descriptor, IPPROTO_TCP, TCP_KEEPINTVL, &intervalSec, sizeof(intervalSec));
  setsockopt(descriptor, IPPROTO_TCP, TCP_KEEPCNT, &probes, sizeof(probes));
  setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &size, sizeof(size));
  setsockopt(descriptor, SOL_SOCKET, SO_SNDBUF, &size, sizeof(size));
}

}  // namespace

WakeUp::WakeUp()
{
  if (pipe2(ends_, O_CLOEXEC | O_NONBLOCK) != 0)
  {
    throw ConnectionError("a pipe cannot be made (" + reason(errno) + ")");
  }
}

WakeUp::~WakeUp()
{
  close(ends_[0]);
  close(ends_[1]);
}

void WakeUp::wake()
{
  const char byte = 1;
  [[maybe_unused]] const ssize_t written = write(ends_[1], &byte, 1);  // a full pipe wakes, too
}

void WakeUp::reset()
{
  char bytes[64];
  while (read(ends_[0], bytes, sizeof(bytes)) > 0)
  {
  }
}

Socket::Socket(Socket&& other) noexcept
  : descriptor_(std::exchange(other.descriptor_, -1))
{
}

Socket& Socket::operator=(Socket&& other) noexcept
{
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

void Socket::close()
{
  if (descriptor_ >= 0)
  {
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

Socket Socket::connectTo(const std::string& host, int port, double timeoutSec, const WakeUp& wakeUp)
{
  const Addresses addresses = resolve(host, port, false);
  Socket made(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!made.isOpen())
  {
    throw ConnectionError("a socket cannot be made (" + reason(errno) + ")");
  }
  tune(made.descriptor_);
  if (connect(made.descriptor_, addresses->ai_addr, addresses->ai_addrlen) != 0)
  {
    if (errno != EINPROGRESS)
    {
      throw ConnectionError("does not answer (" + reason(errno) + ")");
    }
    const Waited waited = waitFor(made.descriptor_, POLLOUT, timeoutSec, wakeUp);
    int error = 0;
    socklen_t size = sizeof(error);
    getsockopt(made.descriptor_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (waited != Waited::Ready || error != 0)
    {
      throw ConnectionError("does not answer (" + reason(error != 0 ? error : ETIMEDOUT) + ")");
    }
  }
  return made;
}

Socket Socket::listenOn(const std::string& address, int port)
{
  const std::string where = address + ":" + std::to_string(port);
  const Addresses addresses = resolve(address, port, true);
  Socket made(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  if (made.isOpen())
  {
    setsockopt(made.descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  }
  if (!made.isOpen() || bind(made.descriptor_, addresses->ai_addr, addresses->ai_addrlen) != 0 || listen(made.descriptor_, 16) != 0)
  {
    throw ConnectionError("nothing can be served on " + where + " (" + reason(errno) + ")");
  }
  return made;
}

Socket Socket::accept(double timeoutSec, const WakeUp& wakeUp) const
{
  if (waitFor(descriptor_, POLLIN, timeoutSec, wakeUp) != Waited::Ready)
  {
    return Socket();
  }
  Socket client(accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (client.isOpen())
  {
    tune(client.descriptor_);
  }
  return client;
}

Socket::Received Socket::receive(
  std::uint8_t* bytes, std::size_t count, std::size_t& received, double timeoutSec, const WakeUp& wakeUp) const
{
  while (received < count)
  {
    const ssize_t now = recv(descriptor_, bytes + received, count - received, 0);
    if (now > 0)
    {
      received += std::size_t(now);
      continue;
    }
    if (now == 0)
    {
      throw ConnectionError("the other side has closed the connection");
    }
    if (errno == EINTR)
    {
      continue;
    }
    if (errno != EAGAIN && errno != EWOULDBLOCK)
    {
      throw ConnectionError("the connection is lost (" + reason(errno) + ")");
    }
    const Waited waited = waitFor(descriptor_, POLLIN, timeoutSec, wakeUp);
    if (waited != Waited::Ready)
    {
      return waited == Waited::Woken ? Received::Woken : Received::TimedOut;
    }
  }
  return Received::All;
}

void Socket::send(const std::uint8_t* bytes, std::size_t count, double timeoutSec, const WakeUp& wakeUp) const
{
  while (count > 0)
  {
    const ssize_t now = ::send(descriptor_, bytes, count, MSG_NOSIGNAL);
    if (now >= 0)
    {
      bytes += now;
      count -= std::size_t(now);
      continue;
    }
    if (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
    {
      throw ConnectionError("the connection is lost (" + reason(errno) + ")");
    }
    if (waitFor(descriptor_, POLLOUT, timeoutSec, wakeUp) != Waited::Ready)
    {
      throw ConnectionError("the other side takes nothing");
    }
  }
}

int Socket::port() const
{
  sockaddr_in address = {};
  socklen_t size = sizeof(address);
  getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

}  // namespace handeye::devices
