// SPDX-License-Identifier: BSD-3-Clause
// What the documents' C++ blocks take for granted.
#include "vtkDSMLightOptions.h"
#include "vtkDSMPolyDataMapper.h"
#include "vtkDSMScene.h"
#include "vtkDSMVolumeMapper.h"

#include "vtkActor.h"
#include "vtkAlgorithm.h"
#include "vtkImageData.h"
#include "vtkMPIController.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkVolume.h"

extern vtkAlgorithm* reader;
extern vtkAlgorithm* source;
extern vtkRenderer* renderer;
extern vtkScalarsToColors* table;
extern vtkRenderWindow* window;
extern int argc;
extern char** argv;
