// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "LandmarkRegistration.h"
#include "Look.h"

#include <Eigen/Core>
#include <QString>
#include <QVector>
#include <QWidget>

#include <memory>
#include <optional>
#include <vector>

namespace handeye
{

/// Registration of a phantom by landmarks: the model's landmarks in a list, touched one after the other with the tracked stylus.
///
/// The panel keeps the points and shows the result; whoever owns the tracker gives it the tip, and whoever calculates answers
/// pairsChanged() with setResult():
///
///     p_Phantom = modelToPhantom * p_Model        mm
class LandmarkPanel : public QWidget
{
  Q_OBJECT

public:
  /// So many have to be touched for a registration.
  static constexpr int FewestLandmarks = 3;

  struct Landmark
  {
    QString name;
    Eigen::Vector3d point_Model = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d> touched_Phantom;
    bool skipped = false;
  };
  /// The landmarks that were touched and not skipped, in the order of the list; what registerLandmarks() takes.
  struct Pairs
  {
    QVector<int> landmarks;  ///< indices into the list
    std::vector<Eigen::Vector3d> points_Model, points_Phantom;
  };

  explicit LandmarkPanel(QWidget* parent = nullptr);
  ~LandmarkPanel() override;

  /// Loads the model's landmarks; what was touched is taken away, and undo() brings it back. @return false: the reason is shown in
  /// the panel
  bool loadModelLandmarks(const QString& path);
  /// Landmarks of a session, with what was touched of them, or none; without a way back.
  void setLandmarks(const QVector<Landmark>& landmarks);
  void forgetTouched();
  const QVector<Landmark>& landmarks() const;
  Pairs pairs() const;

  /// The landmark to be touched next; -1 if all are.
  int currentLandmark() const;
  void setCurrentLandmark(int index);
  bool isHandsFree() const;

  /// Whether the tip can be taken now, and if not, why ("the phantom's marker is not seen").
  void setTipAvailable(bool available, const QString& reason = {});

  /// What registerLandmarks() made of pairs(); nothing: not enough yet. The residuals are those of the pairs' landmarks.
  void setResult(const std::optional<LandmarkRegistrationResult>& result);
  const std::optional<LandmarkRegistrationResult>& result() const;

public slots:
  /// The tip (mm, frame of the phantom's marker) was taken for the current landmark, which the next one follows; the answer to
  /// touchRequested().
  void setTouched(const Eigen::Vector3d& tip_Phantom);
  /// The tip rests here: taken like setTouched() if hands-free touching is on and the tip has left the place it was last taken at
  /// (differentPlaceMm apart). @return whether it was taken
  bool offerTip(const Eigen::Vector3d& tip_Phantom, double differentPlaceMm = 8);
  /// The current landmark's point is taken back, to be touched again.
  void takeBackCurrent();
  void skipCurrent();
  /// All points are taken back.
  void clearTouched();
  /// As it was before the last of all these; with nothing to undo it does nothing.
  void undo();

signals:
  /// "Touch" was pressed: the tip is wanted for this landmark.
  void touchRequested(int landmark);
  void handsFreeChanged(bool on);
  /// A landmark was touched, taken back, skipped or loaded: pairs() is another one.
  void pairsChanged();
  /// The list shows another landmark as the next; its place is to be highlighted on the model.
  void currentLandmarkChanged(int landmark);
  /// The person chose a file to save the registration to, or to take one from (phantom.json).
  void saveRequested(QString path);
  void loadRequested(QString path);

protected:
  void changeEvent(QEvent* event) override;

private:
  class Private;
  std::unique_ptr<Private> d;
};

}  // namespace handeye
