// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <QString>
#include <QVector>
#include <QWidget>

#include <memory>

class QComboBox;

namespace handeye
{

/// The streams that arrive, each with a light, and the choice of which one is what.
class StreamList : public QWidget
{
  Q_OBJECT

public:
  enum class Light
  {
    Live,   ///< a full disc: arriving
    Stale,  ///< a half disc: nothing new for a while, or its poses are not valid now
    Lost    ///< a crossed ring: its source is gone
  };
  enum class Type
  {
    Transform,
    Video,
    Other  ///< cannot be chosen
  };
  enum class Role
  {
    Stylus,
    CameraMarker,
    Phantom,  ///< may be none
    Video,
    RightVideo  ///< of a stereo rig's right eye; may be none
  };
  Q_ENUM(Role)
  static constexpr int RoleCount = 5;

  struct Stream
  {
    QString name;    ///< "StylusToTracker"; each once
    QString source;  ///< "127.0.0.1:18944"; for the tooltip
    Type type = Type::Transform;
    Light light = Light::Lost;
    double rateHz = 0;   ///< 0: unknown
    double ageSec = -1;  ///< since the last sample; negative: unknown
    QString message;     ///< why it is not live; for the last column
  };

  explicit StreamList(QWidget* parent = nullptr);
  ~StreamList() override;

  /// All streams as they are now. A choice whose stream is gone stays, marked as not there.
  void setStreams(const QVector<Stream>& streams);

  /// The stream chosen for a role; empty for none.
  QString choice(Role role) const;
  /// Sets a choice without a signal; the stream need not be there yet.
  void setChoice(Role role, const QString& name);
  QComboBox* choiceBox(Role role) const;

  /// The light of a stream: shape and colour differ.
  static QIcon lightIcon(Light light);
  /// "live", "stale", "lost" in the person's language.
  static QString lightWord(Light light);

  QSize minimumSizeHint() const override;

signals:
  /// A person chose a stream for a role.
  void choiceChanged(handeye::StreamList::Role role, QString name);

protected:
  void resizeEvent(QResizeEvent* event) override;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
