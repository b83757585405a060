// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMSceneMesh_h
#define vtkDSMSceneMesh_h

#include "vtkDSMMapperMember.h"
#include "vtkDSMMeshData.h"
#include "vtkDSMPolyDataMapper.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class vtkActor;

/// The surfaces of one vtkDSMPolyDataMapper in a scene.
class vtkDSMSceneMesh : public vtkDSMMapperMember<vtkDSMPolyDataMapper>
{
public:
  using vtkDSMMapperMember::vtkDSMMapperMember;

  bool HasNewData() override;
  bool NeedsRanks(const vtkDSMRankGroup& group, bool wantsCoarser) const override;
  bool IsOutdated() override { return !this->Mapper || this->Mapper->HasOldData(); }
  bool SharesBlocks(const vtkDSMSceneMember& other) const override;
  void GiveUpBlocks() override;
  bool HasBlocks() const override { return this->Data != nullptr; }
  void Update(const std::shared_ptr<vtkDSMRankGroup>& group, bool newData) override;
  /// One object for each of the meshes.
  void AddTo(rt::Scene& scene) override;

private:
  vtkDSMMeshInput GetInput() const;
  std::vector<std::uint64_t> GetStamp() const;
  vtkDSMMeshContent HashContent() const;
  bool IsTextured() const;
  bool ShowsEdges() const;
  /// Edges are to be shown, but the data were taken in without their flags.
  bool LacksEdges() const;
  rt::MeshObject CreateObject(const vtkDSMMeshData::Part& part, vtkActor* actor);
  std::shared_ptr<const rt::ColorMap> GetColorMap();
  const std::shared_ptr<const rt::Texture>& GetPicture(vtkActor* actor);

  struct State
  {
    std::vector<std::uint64_t> Stamp;
    vtkDSMMeshContent Content;
  };
  State Seen;      ///< state of the data that were taken in, or are equal; see vtkDSMMeshData
  State Found;     ///< new state found by HasNewData, until it is taken in
  int Threads = 1; ///< to look for changes with
  bool Taken = false;
  std::unique_ptr<vtkDSMMeshData> Data;
  std::string Failure;
  unsigned FailureVersion = 0;  ///< the group's when it was tried
  unsigned ReportedVersion = 0; ///< the group's settings version then
  std::shared_ptr<const rt::Texture> Picture;
  /// Stamps of the texture, its image and its transform.
  std::vector<std::uint64_t> PictureSource;
};

#endif
