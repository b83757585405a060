// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkDSMMapperMember_h
#define vtkDSMMapperMember_h

#include "vtkDSMSceneMember.h"

#include "vtkWeakPointer.h"

#include <memory>

/// State that a scene keeps for a mapper of one class, which has options of light and memory and
/// can be asked for a piece.
template <class MapperClass>
class vtkDSMMapperMember : public vtkDSMSceneMember
{
public:
  explicit vtkDSMMapperMember(MapperClass* mapper)
    : Mapper(mapper)
  {
  }

  /// Scenes keep a `Member` of each such mapper from now on.
  template <class Member>
  static void AddKind()
  {
    vtkDSMSceneMember::AddKind(&Create<Member>);
  }

  vtkAlgorithm* GetAlgorithm() const override { return this->Mapper; }
  vtkDSMMemoryOptions* GetMemoryOptions() const override
  {
    return this->Mapper->GetMemoryOptions();
  }
  vtkDSMLightOptions* GetLightOptions() const override { return this->Mapper->GetLightOptions(); }
  void UpdatePiece(int piece, int numberOfPieces) override
  {
    this->Mapper->UpdatePiece(piece, numberOfPieces);
  }

protected:
  vtkWeakPointer<MapperClass> Mapper;

private:
  template <class Member>
  static std::unique_ptr<vtkDSMSceneMember> Create(vtkAlgorithm* mapper)
  {
    auto* mine = MapperClass::SafeDownCast(mapper);
    return mine ? std::make_unique<Member>(mine) : nullptr;
  }
};

#endif
