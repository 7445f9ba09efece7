// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "OpenIGTLinkMessage.h"
#include "Socket.h"
#include "Source.h"

#include <string>
#include <vector>

namespace handeye::devices
{

struct OpenIGTLinkClientOptions
{
  std::string host = "127.0.0.1";
  int port = 18944;
  std::size_t maximumMessageBytes = std::size_t(128) << 20;  ///< a larger one ends the connection before any of it is stored
  double connectTimeoutSec = 2;
  double stallTimeoutSec = 5;     ///< a message that began and does not go on for so long ends the connection
  int maximumDamagedInARow = 10;  ///< so many refused messages in a row end the connection: the stream is out of step
  SampleBufferOptions buffer;

  /// @throws std::invalid_argument with a sentence where a number makes no sense
  void check() const;
};

/// Receives what an OpenIGTLink server (PLUS, 3D Slicer, `handeye simulate`) sends: TRANSFORM, TDATA, QTDATA, POSITION, IMAGE,
/// STATUS and
/// STRING of protocol 1 to 3. Other types are skipped. One client per server; several at once are several clients.
///
/// A server that is not there, vanishes or sends what is no OpenIGTLink is tried again every half second until stop(); the status
/// says
/// what is the matter. A damaged message is counted and left out, the ones after it are taken. Messages without a time (0) get
/// that of their arrival, and the status says so.
class OpenIGTLinkClient : public Source
{
public:
  explicit OpenIGTLinkClient(const OpenIGTLinkClientOptions& options = {});
  ~OpenIGTLinkClient() override;

  std::string name() const override;

protected:
  void run() override;
  void wake() override { wakeUp_.wake(); }

private:
  bool receiveMessage(const Socket& socket);
  bool receiveBody(const Socket& socket, const MessageHeader& header);
  void deliverMessage(const MessageHeader& header);

  OpenIGTLinkClientOptions options_;
  WakeUp wakeUp_;
  FramePool pool_;
  Bytes body_;
  int damagedInARow_ = 0;
  bool isWithoutTimes_ = false;  ///< the sender, as was said
};

}  // namespace handeye::devices
