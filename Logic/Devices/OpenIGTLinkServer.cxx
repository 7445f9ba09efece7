// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenIGTLinkServer.h"

#include <algorithm>
#include <chrono>

namespace handeye::devices
{

namespace
{

constexpr double SendTimeoutSec = 5;

}  // namespace

struct OpenIGTLinkServer::Client
{
  Socket socket;
  std::deque<std::shared_ptr<const Bytes>> queue;
  std::size_t queuedBytes = 0;
  bool isSending = false;
  bool isFinished = false;
  std::thread thread;
};

OpenIGTLinkServer::OpenIGTLinkServer(const OpenIGTLinkServerOptions& options)
  : options_(options)
  , listener_(Socket::listenOn(options.address, options.port))
  , port_(listener_.port())
{
  thread_ = std::thread([this] { acceptClients(); });
}

OpenIGTLinkServer::~OpenIGTLinkServer()
{
  {
    const std::lock_guard lock(mutex_);
    isStopping_ = true;
  }
  wakeUp_.wake();
  changed_.notify_all();
  thread_.join();
  for (const auto& client : clients_)
  {
    client->thread.join();
  }
}

void OpenIGTLinkServer::acceptClients()
{
  while (!isStopping_)
  {
    Socket socket;
    try
    {
      socket = listener_.accept(1, wakeUp_);
    }
    catch (const ConnectionError&)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    removeFinished();
    const std::lock_guard lock(mutex_);
    if (!socket.isOpen() || clients_.size() >= options_.maximumClients || isStopping_)
    {
      continue;
    }
    auto client = std::make_unique<Client>();
    client->socket = std::move(socket);
    Client& added = *client;
    clients_.push_back(std::move(client));
    added.thread = std::thread([this, &added] { serve(added); });
    changed_.notify_all();
  }
}

void OpenIGTLinkServer::removeFinished()
{
  std::vector<std::unique_ptr<Client>> finished;
  {
    const std::lock_guard lock(mutex_);
    const auto gone =
      std::stable_partition(clients_.begin(), clients_.end(), [](const auto& client) { return !client->isFinished; });
    std::move(gone, clients_.end(), std::back_inserter(finished));
    clients_.erase(gone, clients_.end());
  }
  for (const auto& client : finished)
  {
    client->thread.join();
  }
}

void OpenIGTLinkServer::serve(Client& client)
{
  std::unique_lock lock(mutex_);
  try
  {
    while (!isStopping_)
    {
      changed_.wait_for(lock, std::chrono::milliseconds(200), [&] { return isStopping_ || !client.queue.empty(); });
      std::shared_ptr<const Bytes> message;
      if (!client.queue.empty() && !isStopping_)
      {
        message = client.queue.front();
        client.queue.pop_front();
        client.queuedBytes -= message->size();
        client.isSending = true;
      }
      lock.unlock();
      std::uint8_t ignored[4096];
      std::size_t received = 0;
      (void)client.socket.receive(ignored, sizeof(ignored), received, 0, wakeUp_);  // throws when the client is gone
      if (message)
      {
        client.socket.send(message->data(), message->size(), SendTimeoutSec, wakeUp_);
      }
      lock.lock();
      client.isSending = false;
      changed_.notify_all();
    }
  }
  catch (const ConnectionError&)
  {
    lock.lock();
  }
  client.isFinished = true;
  client.isSending = false;
  client.queue.clear();
  client.socket.close();
  changed_.notify_all();
}

void OpenIGTLinkServer::send(Bytes bytes)
{
  const auto message = std::make_shared<const Bytes>(std::move(bytes));
  const std::lock_guard lock(mutex_);
  for (const auto& client : clients_)
  {
    if (client->isFinished)
    {
      continue;
    }
    while (!client->queue.empty() && client->queuedBytes + message->size() > options_.maximumQueueBytes)
    {
      client->queuedBytes -= client->queue.front()->size();
      client->queue.pop_front();
      ++dropped_;
    }
    client->queue.push_back(message);
    client->queuedBytes += message->size();
  }
  changed_.notify_all();
}

std::size_t OpenIGTLinkServer::clientCount() const
{
  const std::lock_guard lock(mutex_);
  return std::size_t(std::count_if(clients_.begin(), clients_.end(), [](const auto& client) { return !client->isFinished; }));
}

bool OpenIGTLinkServer::waitForClient(double timeoutSec)
{
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::duration<double>(timeoutSec),
    [&] { return std::any_of(clients_.begin(), clients_.end(), [](const auto& client) { return !client->isFinished; }); });
}

bool OpenIGTLinkServer::waitUntilSent(double timeoutSec)
{
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::duration<double>(timeoutSec),
    [&]
    {
      return std::all_of(clients_.begin(), clients_.end(),
        [](const auto& client) { return client->isFinished || (client->queue.empty() && !client->isSending); });
    });
}

}  // namespace handeye::devices
