// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMDelivery.h"

#include "vtkDSMScene.h"
#include "vtkPVDSMDrawing.h"
#include "vtkPVDSMFrameReport.h"
#include "vtkPVDSMRankWatch.h"

#include "vtkBoundingBox.h"
#include "vtkCompositeRepresentation.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkOrderedCompositingHelper.h"
#include "vtkPVDataRepresentation.h"
#include "vtkPVDataRepresentationPipeline.h"
#include "vtkPVRenderView.h"
#include "vtkPVRenderViewDataDeliveryManager.h"
#include "vtkPVSession.h"
#include "vtkPVSynchronizedRenderer.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkProcessModule.h"
#include "vtkRemotingCoreConfiguration.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace
{

bool HasRole(vtkPVSession::ServerFlags role)
{
  auto* module = vtkProcessModule::GetProcessModule();
  auto* session = module ? vtkPVSession::SafeDownCast(module->GetActiveSession()) : nullptr;
  return !session || session->HasProcessRole(role);
}

/// Why this rendering process cannot draw anything, and what to do; empty when it can.
std::string FindObstacle()
{
  if (!HasRole(vtkPVSession::DATA_SERVER))
  {
    return "DSM Ray Tracer traces on the data server, but this session has separate data and "
           "render servers. Start pvserver instead of pvdataserver and pvrenderserver.";
  }
  if (vtkRemotingCoreConfiguration::GetInstance()->GetIsInCave())
  {
    return "DSM Ray Traced is not supported in a CAVE: each screen has its own camera, but the "
           "ranks trace one picture together. Use the representation Surface or the filter "
           "Contour.";
  }
  if (!vtkPVDSMDrawing::IsPossible())
  {
    return "No display is available, so ParaView will stop. Start it with: xvfb-run -a -s "
           "\"-noreset -screen 0 1280x1024x24\" COMMAND";
  }
  return {};
}

/// Only subclasses of a view may ask what it renders for. None of these is ever made.
class AskedView : public vtkPVRenderView
{
public:
  static bool IsSelecting(vtkPVRenderView* view)
  {
    return (view->*&AskedView::GetMakingSelection)();
  }
  static bool IsCapturing(vtkPVRenderView* view)
  {
    return (view->*&AskedView::GetInCaptureScreenshot)();
  }
  static vtkPVSynchronizedRenderer* GetSynchronizedRenderers(vtkPVRenderView* view)
  {
    return view->*&AskedView::SynchronizedRenderers;
  }
};

/// Returns whether the image may be refined after it is shown. A captured image is kept, so it must
/// be complete at once.
bool CanRefine(vtkPVRenderView* view)
{
  return view && !AskedView::IsCapturing(view);
}

/// Sets which of the scene's windows are one display (pvserver's --tdx and --tdy).
void SetTileDisplay(vtkDSMScene* scene)
{
  auto* configuration = vtkRemotingCoreConfiguration::GetInstance();
  if (configuration->GetIsInTileDisplay())
  {
    const int* tiles = configuration->GetTileDimensions();
    const int* gaps = configuration->GetTileMullions();
    scene->SetTileDisplay(tiles[0], tiles[1], gaps[0], gaps[1]);
  }
}

/// The edge of the squares of pixels of which one is traced: from 1, at the finest level of detail, to 4.
int GetReduction(double resolution)
{
  constexpr double coarsest = 4.0;
  return static_cast<int>(std::lround(std::pow(coarsest, 1.0 - resolution)));
}

/// Returns whether a representation shows a selection that is not empty. The result is the same on every rank.
bool ShowsSelection(vtkPVDataRepresentation* shown)
{
  if (!shown || !shown->GetVisibility() || !shown->IsA("vtkGeometryRepresentation"))
  {
    return false;
  }
  const auto getInput = [](vtkAlgorithm* algorithm)
  {
    const bool hasInput =
      algorithm->GetNumberOfInputPorts() > 0 && algorithm->GetNumberOfInputConnections(0) > 0;
    return hasInput ? algorithm->GetInputAlgorithm(0, 0) : nullptr;
  };
  vtkAlgorithm* source = getInput(shown);
  if (source && source->IsA("vtkPVPostFilter"))
  {
    source = getInput(source);
  }
  return source && source->IsA("vtkPVExtractSelection") &&
    source->GetNumberOfInputConnections(1) > 0;
}

/// Returns whether the view shows any dataset in a representation that is not the plugin's, or a selection. Axes
/// and text are not composite representations and are ignored.
bool ShowsOthers(vtkView* view)
{
  for (int number = 0; view && number < view->GetNumberOfRepresentations(); ++number)
  {
    vtkDataRepresentation* const known = view->GetRepresentation(number);
    auto* composite = vtkCompositeRepresentation::SafeDownCast(known);
    if (!composite && ShowsSelection(vtkPVDataRepresentation::SafeDownCast(known)))
    {
      return true;
    }
    vtkPVDataRepresentation* shown =
      composite && composite->GetVisibility() ? composite->GetActiveRepresentation() : nullptr;
    if (shown && shown->GetVisibility() && !shown->IsA("vtkPVDSMGeometryRepresentation"))
    {
      return true;
    }
  }
  return false;
}

/// Points evenly in a box. They stand for the data when the view divides the space between the ranks;
/// its kd-tree fails where many points share coordinates, as the corners would.
vtkSmartPointer<vtkPoints> SpreadPoints(const double bounds[6])
{
  constexpr int count = 10;
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  for (int number = 0; number < count * count * count; ++number)
  {
    const double places[3] = { number % count + 0.5, number / count % count + 0.5,
      number / (count * count) + 0.5 };
    double point[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double size = bounds[2 * axis + 1] - bounds[2 * axis];
      point[axis] = bounds[2 * axis] + size * places[axis] / count;
    }
    points->InsertNextPoint(point);
  }
  return points;
}

/// The view takes the placeholder's points for the data when it divides the space. It fails without
/// any, so where nothing is known there are some, too.
void FillPlaceholder(vtkPartitionedDataSet* placeholder, const double* bounds)
{
  const double anywhere[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  const auto points = SpreadPoints(bounds ? bounds : anywhere);
  auto* known = vtkPolyData::SafeDownCast(placeholder->GetPartition(0));
  double spread[6];
  points->GetBounds(spread);
  if (known && std::equal(spread, spread + 6, known->GetPoints()->GetBounds()))
  {
    return;
  }
  vtkNew<vtkPolyData> sample;
  sample->SetPoints(points);
  placeholder->SetPartition(0, sample);
}

/// The first of the nearest boxes.
int FindPart(const std::vector<vtkBoundingBox>& parts, const double place[3])
{
  int nearest = 0;
  double least = VTK_DOUBLE_MAX;
  for (std::size_t part = 0; part < parts.size() && least > 0.0; ++part)
  {
    double square = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double outside = std::max({ parts[part].GetMinPoint()[axis] - place[axis],
        place[axis] - parts[part].GetMaxPoint()[axis], 0.0 });
      square += outside * outside;
    }
    if (square < least)
    {
      least = square;
      nearest = static_cast<int>(part);
    }
  }
  return nearest;
}

} // namespace

vtkSmartPointer<vtkDSMScene> vtkPVDSMDelivery::FindScene(
  vtkPVDataRepresentation* representation, vtkPVRenderView* view)
{
  if (!HasRole(vtkPVSession::RENDER_SERVER))
  {
    return nullptr;
  }
  vtkPVDSMRankWatch::Start();
  const std::string obstacle = FindObstacle();
  if (!obstacle.empty())
  {
    vtkErrorWithObjectMacro(representation, << obstacle);
  }
  if (vtkRemotingCoreConfiguration::GetInstance()->GetIsInCave())
  {
    return nullptr; // each frame would be refused
  }
  return vtkDSMScene::ForRenderer(view->GetRenderer());
}

void vtkPVDSMDelivery::UpdateInSpiteOfCache(vtkPVDataRepresentation* representation)
{
  representation->MarkModified();
  representation->Update();
  vtkPVDataRepresentationPipeline::SafeDownCast(representation->GetExecutive())
    ->SetNeedsUpdate(false);
}

bool vtkPVDSMDelivery::IsChosen(vtkPVDataRepresentation* representation, vtkView* view)
{
  bool isChosen = representation->GetVisibility();
  for (int number = 0; !isChosen && number < view->GetNumberOfRepresentations(); ++number)
  {
    auto* composite = vtkCompositeRepresentation::SafeDownCast(view->GetRepresentation(number));
    isChosen = composite && composite->GetActiveRepresentation() == representation;
  }
  return isChosen;
}

void vtkPVDSMDelivery::KeepData(vtkPVDataRepresentation* representation,
  vtkPartitionedDataSet* placeholder, const Shown& shown, vtkInformation* inInfo,
  vtkInformation* outInfo)
{
  FillPlaceholder(placeholder, shown.Bounds);
  // The size is what the view's thresholds are compared with.
  const unsigned long kibibytes = shown.Data ? shown.Data->GetActualMemorySize() : 0;
  vtkPVRenderView::SetPiece(inInfo, representation, placeholder, kibibytes);
  vtkPVRenderView::SetDeliverToClientAndRenderingProcesses(inInfo, representation, false, false);
  vtkPVRenderView::SetRequiresDistributedRendering(inInfo, representation, true);
  vtkPVRenderView::SetOrderedCompositingConfiguration(
    inInfo, representation, vtkPVRenderView::USE_DATA_FOR_LOAD_BALANCING);
  if (shown.IsTranslucent && ShowsOthers(representation->GetView()))
  {
    outInfo->Set(vtkPVRenderView::NEED_ORDERED_COMPOSITING(), 1);
  }
  else
  {
    outInfo->Remove(vtkPVRenderView::NEED_ORDERED_COMPOSITING());
    // IceT must call every rank's renderer: each has tiles, wherever its data lie. The view looks at
    // one of the two keys only; in order, the ranks are called that have anything to draw, and all
    // have the bounds of the whole frame.
    outInfo->Set(vtkPVRenderView::RENDER_EMPTY_IMAGES(), 1);
  }
}

bool vtkPVDSMDelivery::IsSelecting(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  return renderView && AskedView::IsSelecting(renderView);
}

bool vtkPVDSMDelivery::IsCapturing(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  return renderView && AskedView::IsCapturing(renderView);
}

/// Each rank draws the geometry that it has, wherever the view has divided the space: what is nearest in
/// any of the ranks' pictures is selected, and every rank has one.
void vtkPVDSMDelivery::SelectTheNearest(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  if (renderView && renderView->GetUseOrderedCompositing())
  {
    vtkPVSynchronizedRenderer* renderers = AskedView::GetSynchronizedRenderers(renderView);
    renderers->SetOrderedCompositingHelper(nullptr);
    renderers->SetRenderEmptyImages(true);
  }
}

void vtkPVDSMDelivery::Choose(vtkDSMScene* scene, vtkView* anyView, vtkInformation* inInfo,
  vtkPVDSMFrameReport* report, double seconds)
{
  auto* view = vtkPVRenderView::SafeDownCast(anyView);
  auto* controller = scene->GetController();
  SetTileDisplay(scene);
  scene->SetHidden(IsSelecting(anyView));
  if (IsSelecting(anyView))
  {
    SelectTheNearest(anyView);
  }
  const bool interacts = report && report->GetInteracting();
  const bool isProgressive = report && report->GetProgressive();
  const bool takesFew = interacts || (isProgressive && CanRefine(view));
  const bool othersFollow = interacts || (isProgressive && !IsCapturing(anyView));
  scene->SetSamplesPerFrame(takesFew ? 1 : 0);
  scene->SetInteracting(interacts);
  scene->SetShowsDrafts(report != nullptr);
  scene->SetSecondsPerFrame(othersFollow ? seconds : 0.0);
  // While the user interacts, a picture may be as coarse as its time demands. ParaView's level of detail sets how
  // coarse it is at least.
  const bool usesLevels = view && inInfo->Has(vtkPVRenderView::USE_LOD()) && !IsCapturing(anyView);
  scene->SetInteractiveReduction(
    usesLevels ? GetReduction(view->GetLODResolution()) : (takesFew ? 1 : 0));
  scene->SetAlwaysFinest(!interacts && IsCapturing(anyView));
  if (!view || !controller || controller->GetNumberOfProcesses() < 2)
  {
    scene->DeliverTiles();
  }
  else if (view->GetUseOrderedCompositing())
  {
    auto* manager = vtkPVRenderViewDataDeliveryManager::SafeDownCast(view->GetDeliveryManager());
    const auto order = vtkSmartPointer<vtkOrderedCompositingHelper>::New();
    order->SetBoundingBoxes(manager->GetCuts());
    const int rank = controller->GetLocalProcessId();
    scene->DeliverByPlace([order, rank](vtkCamera* camera)
      { return order->ComputeSortOrder(camera).back() == rank; },
      [parts = manager->GetCuts(), rank](const double place[3])
      { return FindPart(parts, place) == rank; });
  }
  else if (view->GetUseSSAO())
  {
    // Ambient occlusion looks at the neighbors of a pixel, before the ranks' pictures are merged.
    scene->DeliverEverywhere([](vtkCamera*) { return true; });
  }
  else
  {
    scene->DeliverTiles();
  }
}
