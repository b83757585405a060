# SPDX-License-Identifier: BSD-3-Clause
# The settings of light and memory. Made from this table: the classes vtkDSMLightOptions and vtkDSMMemoryOptions, those
# of ParaView (vtkPVDSM...Options), the properties of displays and of the settings page, the panel's lists, and the
# first table of docs/properties.md. cmake/DSMSettings.cmake says what each word means.

dsm_setting(Shadows OWNER scene TYPE bool DEFAULT 0
  LABEL "Shadows" PANEL first ENABLED light
  TEXT "Surfaces cast shadows, also on other datasets and from other ranks' data. Costs about one ray per light.")
dsm_setting(LightRadius OWNER scene TYPE double DEFAULT 0 RANGE 0 10 SLIDER 0 1
  LABEL "Light Radius" PANEL advanced ENABLED light
  TEXT "Apparent radius of every light: the tangent of half the angle that the light fills. 0 gives hard shadows, 0.05
    soft ones. Soft shadows need several samples per pixel.")
dsm_setting(AmbientOcclusionSamples OWNER scene TYPE int DEFAULT 0 RANGE 0 1024 SLIDER 0 64
  LABEL "Ambient Occlusion Samples" PANEL first ENABLED light
  TEXT "Number of ambient occlusion rays per sample. Darkens creases and cavities. 0 turns it off. With 16 samples per
    pixel, 1 ray is enough. With 1 sample per pixel, few rays leave dark speckles.")
dsm_setting(AmbientOcclusionDistance OWNER scene TYPE double DEFAULT 0 RANGE 0
  LABEL "Ambient Occlusion Distance" PANEL advanced ENABLED light
  TEXT "Length of ambient occlusion rays, in world units. Shorter rays are faster and show finer detail. 0 uses a
    fifth of the diagonal of everything visible.")
dsm_setting(Look OWNER scene TYPE enum DEFAULT 2 PAGE_DEFAULT 1 PAGE_ENTRIES 2
  ENTRIES PlainLook "Plain" DepthLook "With depth" AutomaticLook "Automatic"
  LABEL "First Look" PANEL advanced
  TEXT "Look of a view before its light is set. With depth: the brightest light casts faint shadows in still pictures.
    Plain: the same look as Contour. Automatic: the look of the settings page in the application, and Plain in
    scripts. Shadows, ambient occlusion and environment light replace the first look.")
dsm_setting(EnvironmentLight OWNER scene TYPE double DEFAULT 0 RANGE 0 100 SLIDER 0 2
  LABEL "Environment Light" PANEL default ENABLED light
  TEXT "Strength of the light that arrives from all directions, in the colors of the view's background. A gradient's
    lower color arrives from below (-y), its upper color from above. Ambient occlusion blocks this light. 0 turns it
    off.")
dsm_setting(Reflectivity OWNER dataset TYPE double DEFAULT 0 RANGE 0 1 SLIDER 0 1
  LABEL "Reflectivity" PANEL default WHEN no_volume
  TEXT "Fraction of the light that this dataset's surfaces mirror.")
dsm_setting(MaxBounces OWNER scene TYPE int DEFAULT 2 RANGE 0 64 SLIDER 0 64
  LABEL "Maximum Bounces" PANEL advanced WHEN no_volume
  TEXT "Maximum number of times that a ray is mirrored.")
dsm_setting(SamplesPerPixel OWNER scene TYPE int DEFAULT 1 RANGE 1 65536 CHOICES "1 4 16 64 256 1024 4096"
  LABEL "Samples per Pixel" PANEL first
  TEXT "Number of samples per pixel in still pictures. More samples smooth edges, soft shadows and ambient occlusion.
    The slider offers some numbers. Any other whole number can be entered. While the view moves, each picture has 1
    sample per pixel.")
dsm_setting(SampleTolerance OWNER scene TYPE double DEFAULT 0.5 RANGE 0 255
  LABEL "Sample Tolerance" PANEL advanced
  TEXT "Standard error of a color, in steps of 255. A square of 8 x 8 pixels gets no more samples once each of its
    pixels has at least 16 samples and an error below this. Pictures in which translucent surfaces lie among other
    datasets get all samples. 0: all pixels get all samples.")
dsm_setting(Denoise OWNER scene TYPE enum DEFAULT 1
  ENTRIES DenoiseNever "Off" DenoiseIncomplete "While samples are missing" DenoiseAlways "Always"
  LABEL "Denoise" PANEL default ENABLED light
  TEXT "Filter the noise of soft shadows and ambient occlusion on surfaces. Colors, edges and hard shadows stay sharp.
    While samples are missing: filter pictures while the view moves, and until they have all samples per pixel. Always:
    also filter finished pictures, such as screenshots. Pictures of volumes, and pictures in which translucent surfaces
    lie among other datasets, are not filtered.")
dsm_setting(DebugView OWNER scene TYPE enum DEFAULT 0
  ENTRIES Off "Off" Owner "Owner of the data" TracingRank "Rank that traced" Brick "Brick" TileTime "Tile time"
    Normal "Normal" Depth "Depth" NewTiles "Tiles that changed hands" Misses "Misses" Level "Level"
  LABEL "Debug View" PANEL advanced
  TEXT "Color surfaces by a diagnostic quantity instead of their material. Ranks, bricks and levels of detail of volume
    files each have a color. Rank 0 and the finest level are red. Tile time goes from black over red and yellow to white
    (2 ms or more). Normals show x, y, z as red, green, blue. Depth is bright where surfaces are near. Tiles that
    another rank traced in the last picture are red. Misses go from black to white (16 or more bricks that the tile
    waited for).")
dsm_setting(ShowLegend OWNER scene TYPE bool DEFAULT 1
  LABEL "Debug Legend" PANEL advanced
  TEXT "Show a legend for the colors of the debug view.")
dsm_setting(ShowStatistics OWNER scene TYPE bool DEFAULT 0
  LABEL "Show Statistics" PANEL advanced
  TEXT "Show the frame's time, the memory organization, and the number of fetched bricks in the picture.")

dsm_setting(MemoryOrganization OWNER ranks TYPE enum DEFAULT 0
  ENTRIES Automatic "Automatic" Replicated "Replicated" ObjectBased "Object based" PageBased "Page based"
  LABEL "Memory Organization"
  TEXT "How a rank accesses bricks owned by other ranks. Replicated: every rank holds all bricks. Object based: a rank
    fetches bricks on demand into a cache, through a table. Page based: the same, through page faults. Automatic:
    replicated if all bricks fit the memory, otherwise object based. The picture is the same.")
dsm_setting(HostSharing OWNER ranks TYPE bool DEFAULT 1
  LABEL "Share within Hosts"
  TEXT "Ranks on one host read each other's bricks in place, without a copy or a message. Has no effect when page
    based. Off: each rank behaves as if it ran on a host of its own.")
dsm_setting(Memory OWNER ranks TYPE int DEFAULT 0 RANGE 0
  LABEL "Memory (MiB per Rank)" ZERO "automatic"
  TEXT "Memory limit of each rank in MiB, for its own bricks, copies and the cache. 0 uses half of the host's
    available memory, divided by the ranks on the host, and at least 64 MiB.")
dsm_setting(ScratchDirectory OWNER ranks TYPE directory
  LABEL "Scratch Directory"
  TEXT "Directory on a local disk of each rank's node, such as /scratch. Bricks that exceed the memory limit go to a
    file there and are loaded on demand. The file disappears with the process. Empty: such data are refused with an
    error. The picture is the same.")
dsm_setting(LevelOfDetail OWNER ranks TYPE enum DEFAULT 0
  ENTRIES AutomaticLevel "Automatic" FinestLevel "Finest"
  LABEL "Level of Detail"
  TEXT "Level of a volume file with several levels (dsm_convert --levels, Save Data, OME-Zarr). Automatic: the coarsest
    whose samples are not farther apart than Pixels per Sample. In large volumes, near parts are finer than far
    ones. The picture needs fewer bricks. Finest: all that the file has.")
dsm_setting(PixelsPerSample OWNER ranks TYPE double DEFAULT 1 RANGE 0.125 64
  LABEL "Pixels per Sample"
  TEXT "Largest distance of samples in the picture, in pixels, at which Level of Detail chooses a coarser level. 1 shows
    all that pixels can show. Larger values need fewer bricks.")
dsm_setting(CoarserDataWhileMoving OWNER ranks TYPE bool DEFAULT 0
  LABEL "Coarser Data While Moving"
  TEXT "Show a coarser level of a volume file while the camera moves and bricks are being fetched. Requires a file
    with several levels (dsm_convert --levels, Save Data, OME-Zarr). Still pictures, screenshots and scripts always
    show the level that Level of Detail chooses.")
dsm_setting(CacheSize OWNER ranks TYPE int DEFAULT 256 RANGE 1
  LABEL "Cache Limit (MiB per Rank)"
  TEXT "Limit of each rank's cache in MiB, for bricks owned by other ranks.")
dsm_setting(Threads METHOD NumberOfThreads OWNER ranks TYPE int DEFAULT 0 RANGE 0 1024 SLIDER 0 1024
  LABEL "Threads per Rank" ZERO "automatic"
  TEXT "Number of tracing threads of each rank. 0 divides the host's cores by the ranks on the host.")
dsm_setting(Scheduler OWNER ranks TYPE enum DEFAULT 0
  ENTRIES WorkStealing "Work stealing" CentralQueue "Central queue"
  LABEL "Scheduler"
  TEXT "How tiles of the picture are distributed to ranks. Work stealing: a rank starts with the tiles that it traced
    in the last picture, and takes tiles from other ranks when it has none left. Central queue: rank 0 deals out
    tiles. The picture is the same.")
dsm_setting(FrameBudget OWNER ranks TYPE double DEFAULT 0.1 RANGE 0 60
  LABEL "Frame Budget (s)" ZERO "none"
  TEXT "Tracing time in seconds after which the application shows a picture, whatever is missing: the rest shows the
    last picture, or a coarser one, and is traced while the view is still. Screenshots and scripts are always
    complete. 0 waits for each picture.")
dsm_setting(SilenceLimit OWNER ranks TYPE int DEFAULT 60 RANGE 0
  LABEL "Silence Limit (s)" ZERO "none"
  TEXT "Time in seconds after which an unresponsive rank is treated as failed. Frames then end on the other ranks with
    an error that names the rank. A rank that reads or computes is not unresponsive. 0 waits forever.")
