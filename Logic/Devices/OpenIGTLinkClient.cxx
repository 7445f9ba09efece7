// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "OpenIGTLinkClient.h"

#include <algorithm>
#include <array>

namespace handeye::devices
{

void OpenIGTLinkClientOptions::check() const
{
  if (host.empty() || port < 1 || port > 65535)
  {
    throw std::invalid_argument("'" + host + ":" + std::to_string(port) + "': a computer and a port from 1 to 65535 are expected");
  }
  if (!(connectTimeoutSec > 0) || !(stallTimeoutSec > 0) || maximumMessageBytes < 1024 || maximumDamagedInARow < 1)
  {
    throw std::invalid_argument("OpenIGTLink client: positive times and limits are expected");
  }
}

OpenIGTLinkClient::OpenIGTLinkClient(const OpenIGTLinkClientOptions& options)
  : Source(options.buffer)
  , options_(options)
{
  options_.check();
}

OpenIGTLinkClient::~OpenIGTLinkClient()
{
  stopThread();
}

std::string OpenIGTLinkClient::name() const
{
  return options_.host + ":" + std::to_string(options_.port);
}

void OpenIGTLinkClient::run()
{
  wakeUp_.reset();
  if (isStopping())
  {
    return;
  }
  try
  {
    const Socket socket = Socket::connectTo(options_.host, options_.port, options_.connectTimeoutSec, wakeUp_);
    damagedInARow_ = 0;
    isWithoutTimes_ = false;
    countConnection();
    setState(SourceState::Streaming, "connected to " + name());
    while (receiveMessage(socket))
    {
    }
  }
  catch (const ConnectionError& error)
  {
    setProblem(name() + ": " + error.what() + "; trying again");
  }
}

bool OpenIGTLinkClient::receiveMessage(const Socket& socket)
{
  constexpr double IdleSec = 3600;  // between messages a server may be silent as long as it likes; stop() wakes
  std::array<std::uint8_t, HeaderBytes> bytes;
  std::size_t received = 0;
  Socket::Received outcome = socket.receive(bytes.data(), 1, received, IdleSec, wakeUp_);
  if (outcome == Socket::Received::All)
  {
    outcome = socket.receive(bytes.data(), bytes.size(), received, options_.stallTimeoutSec, wakeUp_);
    if (outcome == Socket::Received::TimedOut)
    {
      throw ConnectionError("stopped in the middle of a message's header");
    }
  }
  if (outcome != Socket::Received::All)
  {
    return outcome == Socket::Received::TimedOut;
  }
  std::string problem;
  const std::optional<MessageHeader> header = parseHeader(bytes, problem);
  if (!header)
  {
    countRefused(problem);
    throw ConnectionError(problem);
  }
  if (header->bodyBytes > options_.maximumMessageBytes)
  {
    problem = header->type + " announces " + std::to_string(header->bodyBytes) + " bytes; at most " +
      std::to_string(options_.maximumMessageBytes) + " are taken";
    countRefused(problem);
    throw ConnectionError(problem);
  }
  if (!receiveBody(socket, *header))
  {
    return false;
  }
  deliverMessage(*header);
  return true;
}

/// Memory is taken as the bytes come: an announcement alone costs the sender nothing, and must not cost us.
bool OpenIGTLinkClient::receiveBody(const Socket& socket, const MessageHeader& header)
{
  constexpr std::size_t Step = std::size_t(8) << 20;
  const auto count = std::size_t(header.bodyBytes);
  std::size_t received = 0;
  while (received < count)
  {
    const std::size_t goal = std::min(count, std::max(received + Step, std::min(count, body_.size())));
    if (body_.size() < goal)
    {
      body_.resize(goal);
    }
    const Socket::Received outcome = socket.receive(body_.data(), goal, received, options_.stallTimeoutSec, wakeUp_);
    if (outcome == Socket::Received::TimedOut)
    {
      throw ConnectionError("stopped in the middle of a message");
    }
    if (outcome == Socket::Received::Woken)
    {
      return false;
    }
  }
  return true;
}

void OpenIGTLinkClient::deliverMessage(const MessageHeader& header)
{
  std::string problem = checkCrc(header, body_.data());
  ParsedMessage message;
  if (problem.empty())
  {
    message = parseBody(header, body_.data(), pool_);
    problem = message.problem;
  }
  if (!problem.empty())
  {
    countRefused(problem);
    if (++damagedInARow_ >= options_.maximumDamagedInARow)
    {
      throw ConnectionError(std::to_string(damagedInARow_) + " damaged messages in a row, the last: " + problem);
    }
    return;
  }
  damagedInARow_ = 0;
  if (!(header.timeSec > 0) && !isWithoutTimes_)
  {
    isWithoutTimes_ = true;
    setState(SourceState::Streaming,
      "connected to " + name() + "; " + header.type + " '" + header.device + "' has no time: that of its arrival is taken");
  }
  const double timeSec = header.timeSec > 0 ? header.timeSec : systemTimeSec();
  for (DeviceSample& sample : message.samples)
  {
    sample.timeSec = timeSec;
    deliver(std::move(sample));
  }
}

}  // namespace handeye::devices
