// SPDX-FileCopyrightText: HandEyeCalibration contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The model and its registration to the phantom.
#include "HandEyeWorkbench.h"

#include "MeshReader.h"
#include "ResultFiles.h"
#include "SurfaceDistance.h"

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

/// In the work's thread. @return a sentence where they do not lie on the mesh; empty where they do, or there is none
QString HandEyeWorkbench::problemOfLandmarks(
  vtkPolyData* mesh, const QString& meshPath, const std::vector<Eigen::Vector3d>& points_Model)
{
  const double offMm = mesh ? largestSurfaceDistance(mesh, points_Model) : 0;
  return offMm <= LargestSurfaceDistanceMm
    ? QString()
    : tr("These are no landmarks of %1: one is %2 mm off its surface, at most %3 mm are expected. Load the landmarks that were "
         "picked on this mesh; those that were touched belong to the phantom.")
        .arg(QFileInfo(meshPath).fileName())
        .arg(offMm, 0, 'f', 1)
        .arg(LargestSurfaceDistanceMm, 0, 'f', 0);
}

/// The mesh for the work's thread: what a locator adds to it, it adds to this one alone.
vtkSmartPointer<vtkPolyData> HandEyeWorkbench::meshBeside() const
{
  vtkSmartPointer<vtkPolyData> copy;
  if (model_.mesh)
  {
    copy = vtkSmartPointer<vtkPolyData>::New();
    copy->ShallowCopy(model_.mesh);
  }
  return copy;
}

void HandEyeWorkbench::checkLandmarks(const std::vector<Eigen::Vector3d>& points_Model, bool isRegistered)
{
  beside(WizardStep::Overlay,
    [this, points_Model, isRegistered, mesh = meshBeside(), path = modelPath_]
    {
      const QString problem = problemOfLandmarks(mesh, path, points_Model);
      if (!problem.isEmpty())
      {
        tell(
          [this, problem, isRegistered]
          {
            if (isRegistered && registration_)
            {
              registration_.reset();
              store("phantom", nlohmann::json());
              setModelToPhantom(std::nullopt, {});
            }
            refuse(WizardStep::Overlay, problem);
          });
      }
    });
}

void HandEyeWorkbench::registerLandmarks(
  const std::vector<Eigen::Vector3d>& points_Model, const std::vector<Eigen::Vector3d>& points_Phantom, const QString& touchedModel)
{
  beside(WizardStep::Overlay,
    [this, points_Model, points_Phantom, mesh = meshBeside(), path = modelPath_,
      ofModel = touchedModel.isEmpty() ? modelPath_ : touchedModel]
    {
      const QString problem = ofModel == path ? problemOfLandmarks(mesh, path, points_Model) : QString();
      if (!problem.isEmpty())
      {
        tell([this, problem] { refuse(WizardStep::Overlay, problem); });
        return;
      }
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
