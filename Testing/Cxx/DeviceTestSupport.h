// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OpenIGTLinkMessage.h"
#include "Socket.h"
#include "Source.h"

#include <chrono>
#include <functional>
#include <string>
#include <thread>

namespace handeye::devices::test
{

/// Waits until something is so. @return false after the timeout, which is long: a loaded machine is no failure
inline bool waitUntil(const std::function<bool()>& isSo, double timeoutSec = 20)
{
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeoutSec);
  while (!isSo())
  {
    if (std::chrono::steady_clock::now() > end)
    {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// A server that sends whatever bytes it is told to, to one client at a time.
class RawServer
{
public:
  explicit RawServer(int port = 0)
    : listener_(Socket::listenOn("127.0.0.1", port))
  {
  }

  int port() const { return listener_.port(); }

  bool acceptClient()
  {
    client_ = listener_.accept(20, wakeUp_);
    return client_.isOpen();
  }

  void send(const Bytes& bytes) { client_.send(bytes.data(), bytes.size(), 20, wakeUp_); }
  void hangUp() { client_.close(); }

private:
  WakeUp wakeUp_;
  Socket listener_;
  Socket client_;
};

/// The next sample of this name, the others being dropped.
inline std::optional<DeviceSample> popNamed(Source& source, const std::string& name, double timeoutSec = 20)
{
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeoutSec);
  while (std::chrono::steady_clock::now() < end)
  {
    std::optional<DeviceSample> sample = source.pop(0.1);
    if (sample && sample->name == name)
    {
      return sample;
    }
  }
  return std::nullopt;
}

inline Eigen::Matrix4d shiftedBy(double x)
{
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 3) = x;
  return matrix;
}

}  // namespace handeye::devices::test
