// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneVolume_h
#define vtkDSMSceneVolume_h

#include "vtkDSMSceneMember.h"
#include "vtkDSMVolumeData.h"

#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkDSMVolumeMapper;

/// A volume of a scene.
class vtkDSMSceneVolume : public vtkDSMSceneMember
{
public:
  explicit vtkDSMSceneVolume(vtkDSMVolumeMapper* mapper);
  ~vtkDSMSceneVolume() override;

  vtkAlgorithm* GetAlgorithm() const override;
  vtkDSMMemoryOptions* GetMemoryOptions() const override;
  vtkDSMLightOptions* GetLightOptions() const override;
  void UpdatePiece(int piece, int numberOfPieces) override;
  bool HasNewData() const override;
  void GiveUpBlocks() override;
  void Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData) override;
  /// One object for each of the volume's lattices.
  void AddTo(rt::Scene& scene) override;

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
  /// Whether isovalues and look come from the volume's property; else they are the mapper's.
  bool IsLikeRayCastMapper() const;
  std::string GetIsoArray();
  std::vector<double> GetIsovalues();
  rt::Material GetMaterial(double isovalue);
  const rt::ColorMap& GetColorMap();
  rt::ClipRegion GetClipRegion(const glm::dmat4& dataToWorld) const;

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
};

#endif
