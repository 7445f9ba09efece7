// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The model and its registration to the phantom.
#include "HandEyeWorkbench.h"

#include "MeshReader.h"
#include "ResultFiles.h"

#include <QCoreApplication>
#include <QFileInfo>

#include <dlfcn.h>

namespace handeye
{

namespace
{

/// The folder of the file that this code is a part of: the plugin, wherever it was installed, or a program.
QString ownFolder()
{
  Dl_info info{};
  const bool isKnown = dladdr(reinterpret_cast<const void*>(&ownFolder), &info) != 0 && info.dli_fname;
  return isKnown ? QFileInfo(QString::fromLocal8Bit(info.dli_fname)).absolutePath() : QCoreApplication::applicationDirPath();
}

/// A file that is installed with the plugin, or lies in the source folder that it was built from.
QString meshFile(const char* name)
{
  for (const QString& folder : { ownFolder() + QStringLiteral("/" HANDEYE_MESHES_FROM_MODULE), QStringLiteral(HANDEYE_MESHES_DIR) })
  {
    const QString file = folder + QLatin1Char('/') + QString::fromLatin1(name);
    if (QFileInfo::exists(file))
    {
      return file;
    }
  }
  return {};
}

}  // namespace

QString HandEyeWorkbench::ownModel()
{
  return meshFile("Vertebra.ply");
}

QString HandEyeWorkbench::ownLandmarks()
{
  return meshFile("VertebraLandmarks.txt");
}

void HandEyeWorkbench::loadModel(const QString& path)
{
  wantedModelPath_ = path;
  beside(WizardStep::Overlay,
    [this, path]
    {
      const OverlayMesh mesh = prepareOverlayMesh(readMesh(path.toStdString()));
      tell(
        [this, mesh, path]
        {
          if (path != wantedModelPath_)
          {
            return;  // another one was asked for meanwhile
          }
          model_ = mesh;
          modelPath_ = path;
          registeredModelPath_ = registeredModelPath_.isEmpty() ? path : registeredModelPath_;
          storeModel();
          emit modelChanged();
          emit registrationChanged();
          emit stateChanged();
        });
    });
}

void HandEyeWorkbench::storeModel()
{
  store("model", { { "file", modelPath_.toStdString() }, { "registeredFile", registeredModelPath_.toStdString() } });
}

void HandEyeWorkbench::setModelToPhantom(const std::optional<Eigen::Isometry3d>& modelToPhantom, const QString& madeForModel)
{
  modelToPhantom_ = modelToPhantom;
  isTouchingAnew_ = false;
  registeredModelPath_ = madeForModel.isEmpty() ? modelPath_ : madeForModel;
  if (!modelPath_.isEmpty())
  {
    storeModel();
  }
  emit registrationChanged();
  emit stateChanged();
}

bool HandEyeWorkbench::isRegisteredForAnotherModel() const
{
  return modelToPhantom_ && !modelPath_.isEmpty() && registeredModelPath_ != modelPath_;
}

void HandEyeWorkbench::keepRegistration()
{
  setModelToPhantom(modelToPhantom_, modelPath_);
}

void HandEyeWorkbench::registerLandmarks(
  const std::vector<Eigen::Vector3d>& points_Model, const std::vector<Eigen::Vector3d>& points_Phantom, const QString& touchedModel)
{
  beside(WizardStep::Overlay,
    [this, points_Model, points_Phantom, ofModel = touchedModel.isEmpty() ? modelPath_ : touchedModel]
    {
      const LandmarkRegistrationResult result = handeye::registerLandmarks(points_Model, points_Phantom);
      tell(
        [this, result, ofModel]
        {
          registration_ = result;
          // One that was refused does not come back with the session.
          store("phantom", result.isUsable() ? phantomJson(result) : nlohmann::json());
          setModelToPhantom(result.isUsable() ? std::optional(result.modelToPhantom) : std::nullopt, ofModel);
        });
    });
}

void HandEyeWorkbench::setTouchingAnew(bool isAnew)
{
  if (isTouchingAnew_ != isAnew)
  {
    isTouchingAnew_ = isAnew;
    emit stateChanged();
  }
}

void HandEyeWorkbench::loadRegistration(const QString& path, const QString& madeForModel)
{
  beside(WizardStep::Overlay,
    [this, path, madeForModel]
    {
      const Eigen::Isometry3d modelToPhantom = readPhantomRegistration(path.toStdString());
      tell(
        [this, modelToPhantom, madeForModel, document = readResult(path.toStdString(), "modelToPhantom")]
        {
          store("phantom", document);
          registration_.reset();
          setModelToPhantom(modelToPhantom, madeForModel);
        });
    });
}

void HandEyeWorkbench::storeLandmarks(const nlohmann::json& landmarks)
{
  storedLandmarks_ = landmarks;
  store("landmarks", landmarks);
}

/// What the landmarks that came back with the session say of the registration that did, if it is theirs.
void HandEyeWorkbench::recallRegistration(
  const std::vector<Eigen::Vector3d>& points_Model, const std::vector<Eigen::Vector3d>& points_Phantom)
{
  beside(WizardStep::Overlay,
    [this, points_Model, points_Phantom]
    {
      const LandmarkRegistrationResult result = handeye::registerLandmarks(points_Model, points_Phantom);
      tell(
        [this, result]
        {
          constexpr double SameTransform = 1e-6;
          if (modelToPhantom_ && !registration_ && result.isUsable() &&
            (modelToPhantom_->matrix() - result.modelToPhantom.matrix()).cwiseAbs().maxCoeff() < SameTransform)
          {
            registration_ = result;
            emit registrationChanged();
            emit stateChanged();
          }
        });
    });
}

void HandEyeWorkbench::saveRegistration(const QString& path)
{
  if (registration_ && registration_->isUsable())
  {
    beside(WizardStep::Overlay, [path, document = phantomJson(*registration_)] { writeJson(path.toStdString(), document); });
  }
}

}  // namespace handeye
