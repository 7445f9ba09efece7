// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace handeye::devices
{

/// A connection that is lost, cannot be made, or does not go on; the message is a sentence for a person.
class ConnectionError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Wakes a thread that waits for a socket.
class WakeUp
{
public:
  WakeUp();
  ~WakeUp();
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  void wake();
  /// Back to sleep.
  void reset();
  int descriptor() const { return ends_[0]; }

private:
  int ends_[2] = { -1, -1 };
};

/// A TCP socket of which no call waits without a limit. (libopenigtlink's own waits for a connection as long as the system likes,
/// and
/// cannot be woken.)
class Socket
{
public:
  Socket() = default;
  explicit Socket(int descriptor)
    : descriptor_(descriptor)
  {
  }
  ~Socket() { close(); }
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;

  /// @throws ConnectionError with the reason; std::invalid_argument for a port out of 1 to 65535
  static Socket connectTo(const std::string& host, int port, double timeoutSec, const WakeUp& wakeUp);

  /// @param port 0 for any that is free; see port()
  /// @throws ConnectionError
  static Socket listenOn(const std::string& address, int port);

  /// @return an open socket for a new client, or a closed one after the timeout or if woken
  Socket accept(double timeoutSec, const WakeUp& wakeUp) const;

  /// What receive() has to say.
  enum class Received
  {
    All,
    TimedOut,  ///< nothing came within the time; `received` says how far it got
    Woken
  };

  /// Waits for exactly `count` bytes; the timeout counts from the last that came.
  /// @param received in: how many are there already; out: how many now
  /// @throws ConnectionError where the other side is gone
  Received receive(std::uint8_t* bytes, std::size_t count, std::size_t& received, double timeoutSec, const WakeUp& wakeUp) const;

  /// Sends all of it. The timeout counts from the last byte that went.
  /// @throws ConnectionError where the other side is gone or takes nothing
  void send(const std::uint8_t* bytes, std::size_t count, double timeoutSec, const WakeUp& wakeUp) const;

  bool isOpen() const { return descriptor_ >= 0; }
  int port() const;
  void close();

private:
  int descriptor_ = -1;
};

}  // namespace handeye::devices
