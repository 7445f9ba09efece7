// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OpenIGTLinkMessage.h"
#include "Socket.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace handeye::devices
{

struct OpenIGTLinkServerOptions
{
  std::string address = "127.0.0.1";  ///< who may come: this computer alone; "0.0.0.0" for the network
  int port = 18944;                   ///< 0 for any that is free
  std::size_t maximumClients = 16;
  std::size_t maximumQueueBytes = std::size_t(64) << 20;  ///< of one client; one that does not keep up loses the oldest messages
};

/// Sends messages to whoever connects, over OpenIGTLink. It listens from construction to destruction, and nothing else in this
/// program
/// listens. What clients send is read and thrown away.
///
/// send() may be called from any thread.
class OpenIGTLinkServer
{
public:
  /// @throws ConnectionError where the port cannot be had
  explicit OpenIGTLinkServer(const OpenIGTLinkServerOptions& options = {});
  ~OpenIGTLinkServer();
  OpenIGTLinkServer(const OpenIGTLinkServer&) = delete;
  OpenIGTLinkServer& operator=(const OpenIGTLinkServer&) = delete;

  int port() const { return port_; }
  std::size_t clientCount() const;

  /// Queues a message for every client.
  void send(Bytes message);

  /// Waits until a client has connected. @return false after the timeout
  bool waitForClient(double timeoutSec);
  /// Waits until all queues are empty. @return false after the timeout
  bool waitUntilSent(double timeoutSec);

  /// Messages that gave way because a client did not keep up.
  std::uint64_t droppedCount() const { return dropped_; }

private:
  struct Client;

  void acceptClients();
  void serve(Client& client);
  void removeFinished();

  OpenIGTLinkServerOptions options_;
  WakeUp wakeUp_;
  Socket listener_;
  int port_ = 0;
  std::atomic<bool> isStopping_{ false };
  std::atomic<std::uint64_t> dropped_{ 0 };
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::unique_ptr<Client>> clients_;
  std::thread thread_;
};

}  // namespace handeye::devices
