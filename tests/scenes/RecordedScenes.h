// SPDX-License-Identifier: BSD-3-Clause
#ifndef tests_scenes_RecordedScenes_h
#define tests_scenes_RecordedScenes_h

#include "tests/scenes/SceneStage.h"

#include <functional>
#include <string>
#include <vector>

/// A scene whose picture is on record.
struct RecordedScene
{
  std::string Name; ///< feature.case
  std::function<void(SceneStage&)> Build;
  /// The picture tells who did what: it is that of one rank only.
  bool ShowsRanks = false;
};

/// Types, shapes, missing data, bricks and colors of volumes.
void AddVolumeScenes(std::vector<RecordedScene>& scenes);
/// Levels of leaves, with every jump and holes: isosurfaces, slices, media.
void AddCellScenes(std::vector<RecordedScene>& scenes);
void AddLevelScenes(std::vector<RecordedScene>& scenes);
/// Media: types, shapes, transfer functions, media in one another and with surfaces, and the light that gets through.
void AddMediumScenes(std::vector<RecordedScene>& scenes);
/// Planes through volumes: types, shapes, looks, clip regions, and with isosurfaces and media.
void AddSliceScenes(std::vector<RecordedScene>& scenes);
/// Meshes from all sides, and what can be painted on them.
void AddMeshScenes(std::vector<RecordedScene>& scenes);
/// Lights, shadows, light from all around, mirrors.
void AddLightScenes(std::vector<RecordedScene>& scenes);
/// Where objects are, what is shown of them, several of them, and the picture itself.
void AddFrameScenes(std::vector<RecordedScene>& scenes);

/// All of them: every feature by itself, and features together.
std::vector<RecordedScene> CreateRecordedScenes();

#endif
