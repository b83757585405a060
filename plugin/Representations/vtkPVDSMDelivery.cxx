// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVDSMDelivery.h"

#include "vtkDSMScene.h"

#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkOrderedCompositingHelper.h"
#include "vtkPVDataRepresentation.h"
#include "vtkPVDataRepresentationPipeline.h"
#include "vtkPVRenderView.h"
#include "vtkPVRenderViewDataDeliveryManager.h"
#include "vtkPVRenderingCapabilitiesInformation.h"
#include "vtkPVSession.h"
#include "vtkProcessModule.h"
#include "vtkSmartPointer.h"

#include <string>

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
    return "DSM Ray Traced traces where the data are, but here data and pictures have different "
           "servers. Start pvserver in the place of pvdataserver and pvrenderserver.";
  }
  using Capabilities = vtkPVRenderingCapabilitiesInformation;
  if (!Capabilities::Supports(Capabilities::GetLocalCapabilities(), Capabilities::RENDERING))
  {
    return "There is no display to draw on, and ParaView is going to stop. Start it with: "
           "xvfb-run -a -s \"-noreset -screen 0 1280x1024x24\" COMMAND";
  }
  return {};
}

} // namespace

vtkSmartPointer<vtkDSMScene> vtkPVDSMDelivery::FindScene(
  vtkPVDataRepresentation* representation, vtkPVRenderView* view)
{
  if (!HasRole(vtkPVSession::RENDER_SERVER))
  {
    return nullptr;
  }
  const std::string obstacle = FindObstacle();
  if (!obstacle.empty())
  {
    vtkErrorWithObjectMacro(representation, << obstacle);
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

void vtkPVDSMDelivery::KeepData(vtkPVDataRepresentation* representation, vtkDataObject* placeholder,
  vtkInformation* inInfo, vtkInformation* outInfo)
{
  vtkPVRenderView::SetPiece(inInfo, representation, placeholder);
  vtkPVRenderView::SetDeliverToClientAndRenderingProcesses(inInfo, representation, false, false);
  vtkPVRenderView::SetRequiresDistributedRendering(inInfo, representation, true);
  // IceT must call every rank's renderer: each has tiles, wherever its data lie.
  outInfo->Set(vtkPVRenderView::RENDER_EMPTY_IMAGES(), 1);
}

void vtkPVDSMDelivery::Choose(vtkDSMScene* scene, vtkView* anyView)
{
  auto* view = vtkPVRenderView::SafeDownCast(anyView);
  auto* controller = scene->GetController();
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
    scene->DeliverEverywhere(
      [order, rank](vtkCamera* camera) { return order->ComputeSortOrder(camera).back() == rank; });
  }
  else if (view->GetUseSSAO())
  {
    // Ambient occlusion looks at the neighbours of a pixel, before the ranks' pictures are merged.
    scene->DeliverEverywhere([](vtkCamera*) { return true; });
  }
  else
  {
    scene->DeliverTiles();
  }
}
