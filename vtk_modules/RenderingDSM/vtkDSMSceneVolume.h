// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneVolume_h
#define vtkDSMSceneVolume_h

#include "DSMRayTracing/frame/Scene.h"
#include "vtkDSMMemorySettings.h"
#include "vtkDSMVolumeData.h"

#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkDSMVolumeMapper;
class vtkVolume;

/// What a scene keeps of one volume: its data in bricks, and what was wrong with it.
class vtkDSMSceneVolume
{
public:
  explicit vtkDSMSceneVolume(vtkDSMVolumeMapper* mapper);
  ~vtkDSMSceneVolume();

  vtkDSMVolumeMapper* GetMapper() const;

  /// Local: whether this rank's data are other than what was taken in.
  bool HasNewData() const;

  /// What it asks for.
  vtkDSMMemorySettings GetMemorySettings() const;

  /// Local, in the same order on every rank: retires its bricks; the next Update publishes them again.
  void GiveUpBlocks();

  /// Collective. Takes in what is missing: everything when any rank has new data, else the arrays
  /// that the mapper names and that are not there yet. What goes wrong is kept as a message.
  void Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData);

  /// Local: one object for each of the volume's lattices.
  void AddTo(rt::Scene& scene, vtkVolume* volume);

  /// Reports the messages that are new since the last call.
  void ReportMessages();

private:
  struct Published
  {
    vtkDSMVolumeData::Choice Choice;
    vtkDSMVolumeData::Fields Fields; ///< empty when it failed
    std::string Failure;
    unsigned SettingsVersion = 0; ///< of the memory's settings when it was tried
  };

  std::shared_ptr<Published> Require(const vtkDSMVolumeData::Choice& choice, const char* purpose,
    unsigned settingsVersion, const std::vector<std::shared_ptr<Published>>& known);
  std::vector<double> GetIsovalues();
  const rt::ColorMap& GetColorMap();

  vtkWeakPointer<vtkDSMVolumeMapper> Mapper;
  const vtkDataObject* SeenData = nullptr;
  vtkMTimeType SeenTime = 0;
  bool Taken = false;
  std::unique_ptr<vtkDSMVolumeData> Data;
  std::shared_ptr<Published> Iso;
  std::shared_ptr<Published> Color;
  rt::ColorMap Colors;
  vtkMTimeType ColorsTime = 0;
  const void* ColorsSource = nullptr;
  std::string DataFailure;
  std::vector<std::string> Messages;
  std::vector<std::string> Reported;
};

#endif
