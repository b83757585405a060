// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkPVDSMExportProp_h
#define vtkPVDSMExportProp_h

#include "vtkActor.h"
#include "vtkProp.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <optional>
#include <vector>

class vtkPVDataRepresentation;
class vtkPolyData;

/// Stands in a view's renderer for a dataset that is traced, when exporters (glTF, X3D, VRML ...) ask the renderer
/// for its actors: then, and only then, the surface is extracted on all ranks and brought here as triangles. Draws
/// nothing. On the client.
class vtkPVDSMExportProp : public vtkProp
{
public:
  static vtkPVDSMExportProp* New();
  vtkTypeMacro(vtkPVDSMExportProp, vtkProp);

  /// More would fill the memory of client and exporter, and no viewer of such files would take them.
  static constexpr vtkTypeInt64 MostPolygons = 10000000;
  /// From here on, the size is told.
  static constexpr vtkTypeInt64 ManyPolygons = 1000000;

  /// Makes an actor that shows polygons as the representation would.
  using ActorMaker = std::function<vtkSmartPointer<vtkActor>(vtkPolyData* polygons)>;

  /// Whose surface; has to live as long.
  void SetRepresentation(vtkPVDataRepresentation* representation, ActorMaker make);

  /// What was extracted is not the view's any more.
  void Forget() { this->Actors.reset(); }

  void GetActors(vtkPropCollection* actors) override;
  double* GetBounds() override { return nullptr; }

protected:
  vtkPVDSMExportProp();
  ~vtkPVDSMExportProp() override;

private:
  vtkPVDSMExportProp(const vtkPVDSMExportProp&) = delete;
  void operator=(const vtkPVDSMExportProp&) = delete;

  /// One for each look of blocks. Of nothing, and of too much, which is an error, none.
  std::vector<vtkSmartPointer<vtkActor>> MakeActors();

  vtkPVDataRepresentation* Representation = nullptr;
  ActorMaker Make;
  std::optional<std::vector<vtkSmartPointer<vtkActor>>> Actors; ///< of the last picture
};

#endif
