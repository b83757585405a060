// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMMeshBlock.h"

#include "DSMCore/Error.h"
#include "vtkDSMPolyDataMapper.h"

#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeRange.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <string>

namespace
{

/// What holds for a block unless it is set for the block itself.
struct Inherited
{
  bool Visible = true;
  vtkDSMMeshBlock::Look Appearance;
};

void Visit(vtkDataObject* data, vtkCompositeDataDisplayAttributes* attributes, Inherited state,
  std::vector<vtkDSMMeshBlock>& blocks)
{
  if (attributes)
  {
    if (attributes->HasBlockVisibility(data))
    {
      state.Visible = attributes->GetBlockVisibility(data);
    }
    if (attributes->HasBlockOpacity(data))
    {
      state.Appearance.Opacity =
        static_cast<float>(std::clamp(attributes->GetBlockOpacity(data), 0.0, 1.0));
    }
    if (attributes->HasBlockColor(data))
    {
      double color[3];
      attributes->GetBlockColor(data, color);
      std::copy_n(color, 3, state.Appearance.Color);
    }
  }
  if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
  {
    for (vtkDataObject* child : vtk::Range(tree, vtk::DataObjectTreeOptions::SkipEmptyNodes))
    {
      Visit(child, attributes, state, blocks);
    }
    return;
  }
  auto* polyData = vtkPolyData::SafeDownCast(data);
  if (!polyData)
  {
    throw dsm::Error(std::string("A dataset of type ") + data->GetClassName() +
      " is not a surface. Apply Extract Surface first.");
  }
  if (state.Visible && polyData->GetNumberOfPoints() > 0)
  {
    blocks.push_back({ polyData, state.Appearance });
  }
}

} // namespace

std::vector<vtkDSMMeshBlock> vtkDSMMeshBlock::Collect(vtkDSMPolyDataMapper* mapper)
{
  std::vector<vtkDSMMeshBlock> blocks;
  if (mapper->GetNumberOfInputConnections(0) > 0)
  {
    if (vtkDataObject* data = mapper->GetInputDataObject(0, 0))
    {
      Visit(data, mapper->GetCompositeDataDisplayAttributes(), {}, blocks);
    }
  }
  return blocks;
}
