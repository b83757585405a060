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
  /// Exports with more polygons report their size.
  static constexpr vtkTypeInt64 ManyPolygons = 1000000;

  /// Makes an actor that shows polygons as the representation would.
  using ActorMaker = std::function<vtkSmartPointer<vtkActor>(vtkPolyData* polygons)>;

  /// Sets the representation whose surface is exported; it must outlive this prop.
  void SetRepresentation(vtkPVDataRepresentation* representation, ActorMaker make);

  /// Discards the extracted actors, because the view has changed.
  void Forget() { this->Actors.reset(); }

  void GetActors(vtkPropCollection* actors) override;
  double* GetBounds() override { return nullptr; }

protected:
  vtkPVDSMExportProp();
  ~vtkPVDSMExportProp() override;

private:
  vtkPVDSMExportProp(const vtkPVDSMExportProp&) = delete;
  void operator=(const vtkPVDSMExportProp&) = delete;

  /// Makes one actor for each look of blocks. Returns none if there are no polygons, or too many, which is an
  /// error.
  std::vector<vtkSmartPointer<vtkActor>> MakeActors();

  vtkPVDataRepresentation* Representation = nullptr;
  ActorMaker Make;
  std::optional<std::vector<vtkSmartPointer<vtkActor>>> Actors; ///< actors of the last image
};

#endif
