// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CameraPage.h"

#include "LensPanel.h"
#include "ui_CameraPage.h"

#include <QFileDialog>

namespace handeye
{

CameraPage::CameraPage(HandEyeWorkbench& workbench, QWidget* parent)
  : WizardPage(workbench, WizardStep::Camera, parent)
  , ui_(std::make_unique<Ui::CameraPage>())
{
  ui_->setupUi(this);
  lensPanel_ = new LensPanel(workbench, ui_->lensCalibrationPlace);
  ui_->lensCalibrationPlaceLayout->setContentsMargins(0, 0, 0, 0);
  ui_->lensCalibrationPlaceLayout->addWidget(lensPanel_);
  connect(ui_->loadButton, &QPushButton::clicked, this, &CameraPage::load);
  connect(ui_->roomCameraButton, &QPushButton::clicked, &workbench_, &HandEyeWorkbench::takeRoomCamera);
}

CameraPage::~CameraPage() = default;

void CameraPage::leave()
{
  workbench_.lens().stop();
}

void CameraPage::load()
{
  const QString path =
    QFileDialog::getOpenFileName(this, tr("Camera file"), {}, tr("Camera files (*.yml *.yaml *.xml *.json *.txt);;All files (*)"));
  if (!path.isEmpty())
  {
    workbench_.loadCamera(path);
  }
}

void CameraPage::refresh()
{
  lensPanel_->refresh();
  const std::optional<HandEyeWorkbench::Camera>& camera = workbench_.camera();
  ui_->roomCameraButton->setVisible(workbench_.devices().room() != nullptr);
  ui_->originLabel->setText(camera ? tr("From %1.").arg(camera->origin) : tr("The lens is not known yet."));
  ui_->lensLabel->setVisible(camera.has_value());
  QStringList warnings;
  if (camera)
  {
    const CameraModel& lens = camera->file.camera;
    QStringList coefficients;
    for (const double coefficient : lens.distortionCoefficients())
    {
      coefficients << QLocale().toString(coefficient, 'g', 4);
    }
    ui_->lensLabel->setText(
      tr("<table cellspacing='4'><tr><td>Image:</td><td>%1</td></tr><tr><td>Focal length:</td><td>%2 x %3 px</td></tr>"
         "<tr><td>Principal point:</td><td>%4, %5 px</td></tr><tr><td>Distortion:</td><td>%6</td></tr></table>")
        .arg(lens.hasImageSize() ? tr("%1 x %2 px").arg(lens.width()).arg(lens.height()) : tr("the file does not say its size"))
        .arg(lens.fx(), 0, 'f', 1)
        .arg(lens.fy(), 0, 'f', 1)
        .arg(lens.cx(), 0, 'f', 1)
        .arg(lens.cy(), 0, 'f', 1)
        .arg(coefficients.isEmpty() ? tr("none") : coefficients.join(QStringLiteral("  "))));
    for (const std::string& warning : camera->file.warnings)
    {
      warnings << QString::fromStdString(warning);
    }
  }
  ui_->warningLabel->setText(warnings.join(QLatin1Char('\n')));
  ui_->warningLabel->setVisible(!warnings.isEmpty());
}

}  // namespace handeye
