// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDSMMeshBlock.h"

#include "DSMCore/base/Error.h"

#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeRange.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <string>
#include <tuple>

namespace
{

/// Walks the tree of a dataset. Nodes are counted also where this rank has nothing.
class Walk
{
public:
  Walk(vtkCompositeDataDisplayAttributes* attributes, std::vector<vtkDSMMeshBlock>& blocks)
    : Attributes(attributes)
    , Blocks(blocks)
  {
  }

  /// `look`: what holds for the data unless it is set for them.
  void Visit(vtkDataObject* data, vtkDSMMeshBlock::Look look)
  {
    const std::uint32_t number = this->Count++;
    if (data)
    {
      this->Override(data, look);
      this->VisitAs(data, number, look);
    }
  }

private:
  void Override(vtkDataObject* data, vtkDSMMeshBlock::Look& look) const
  {
    if (!this->Attributes)
    {
      return;
    }
    if (this->Attributes->HasBlockVisibility(data))
    {
      look.Visible = this->Attributes->GetBlockVisibility(data) ? 1 : 0;
    }
    if (this->Attributes->HasBlockOpacity(data))
    {
      look.Opacity =
        static_cast<float>(std::clamp(this->Attributes->GetBlockOpacity(data), 0.0, 1.0));
    }
    if (this->Attributes->HasBlockColor(data))
    {
      double color[3];
      this->Attributes->GetBlockColor(data, color);
      std::copy_n(color, 3, look.Color);
    }
  }

  void VisitAs(vtkDataObject* data, std::uint32_t number, const vtkDSMMeshBlock::Look& look)
  {
    if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
    {
      // How many pieces a surface has is each rank's own affair.
      const bool pieces = tree->IsA("vtkPartitionedDataSet") || tree->IsA("vtkMultiPieceDataSet");
      for (vtkDataObject* child : vtk::Range(tree, vtk::DataObjectTreeOptions::None))
      {
        if (!pieces)
        {
          this->Visit(child, look);
        }
        else if (child)
        {
          vtkDSMMeshBlock::Look own = look;
          this->Override(child, own);
          this->VisitAs(child, number, own);
        }
      }
      return;
    }
    auto* polyData = vtkPolyData::SafeDownCast(data);
    if (!polyData)
    {
      throw dsm::Error(std::string("A dataset of type ") + data->GetClassName() +
        " is not a surface. Apply Extract Surface first.");
    }
    if (polyData->GetNumberOfPoints() > 0)
    {
      this->Blocks.push_back({ polyData, number, look });
    }
  }

  vtkCompositeDataDisplayAttributes* Attributes; ///< may be null
  std::vector<vtkDSMMeshBlock>& Blocks;
  std::uint32_t Count = 0;
};

} // namespace

bool vtkDSMMeshBlock::Look::operator<(const Look& other) const
{
  const auto order = [](const Look& look)
  {
    return std::make_tuple(look.Visible, look.Opacity, look.Color[0], look.Color[1], look.Color[2]);
  };
  return order(*this) < order(other);
}

std::vector<vtkDSMMeshBlock> vtkDSMMeshBlock::Collect(
  vtkDataObject* data, vtkCompositeDataDisplayAttributes* attributes)
{
  std::vector<vtkDSMMeshBlock> blocks;
  Walk(attributes, blocks).Visit(data, {});
  return blocks;
}
