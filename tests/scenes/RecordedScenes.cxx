// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenes/RecordedScenes.h"

std::vector<RecordedScene> CreateRecordedScenes()
{
  std::vector<RecordedScene> scenes;
  AddVolumeScenes(scenes);
  AddLevelScenes(scenes);
  AddCellScenes(scenes);
  AddMeshScenes(scenes);
  AddLightScenes(scenes);
  AddMediumScenes(scenes);
  AddSliceScenes(scenes);
  AddFrameScenes(scenes);
  return scenes;
}
