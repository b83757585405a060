# SPDX-License-Identifier: BSD-3-Clause
# The properties of displays that have a value each. Made from this table: the methods of mappers
# (vtkDSMVolumeDisplayMapper, vtkDSMMeshDisplayMapper), those of the plugin's displays that forward to them, the
# properties, the panel's lists, and rows of docs/properties.md. cmake/DSMSettings.cmake says what each word means.
# Where a property takes effect, the mapper has its value: vtkDSMVolumeLook, vtkDSMSceneVolume, vtkDSMSceneMesh.

dsm_setting(IgnoreValues OWNER voxels TYPE bool DEFAULT 0
  LABEL "Values to Ignore" PANEL advanced WHEN isosurfaces|volume|slices
  TEXT "Treat values outside of Valid Range as missing, like NaN: cells that have such a value are not shown. Values
    that a file declares as missing are never shown."
  DETAILS "They do not count for the automatic isovalue.")
dsm_setting(ValidRange OWNER voxels TYPE range DEFAULT "-1.7976931348623157e308 1.7976931348623157e308"
  LABEL "Valid Range" PANEL advanced WHEN isosurfaces|volume|slices DSMIgnoreValues=1
  TEXT "Lowest and highest value that is not ignored.")
dsm_setting(MaskArray OWNER voxels TYPE array ARRAYS input_array_values
  LABEL "Mask Array" PANEL advanced WHEN isosurfaces|volume|slices
  TEXT "Array whose values choose the cells that are shown. With a point array, a cell is shown if all of its corners
    have chosen values. With a cell array, if the cell has one."
  DETAILS "Image data, rectilinear, structured and unstructured grids can have a mask. The first of several components
    counts. Hidden cells do not count in the means of cells at points. Empty: no mask.")
dsm_setting(MaskRange OWNER voxels TYPE range DEFAULT "-1.7976931348623157e308 1.7976931348623157e308"
  LABEL "Mask Range" PANEL advanced WHEN isosurfaces|volume|slices DSMMaskArray.4!=None
  TEXT "Lowest and highest value of the mask array that is shown, while Mask Values is empty.")
dsm_setting(MaskValues OWNER voxels METHOD MaskValue TYPE numbers
  LABEL "Mask Values" PANEL advanced WHEN isosurfaces|volume|slices DSMMaskArray.4!=None
  TEXT "Values of the mask array that are shown, such as labels. A list that is not empty replaces Mask Range.")
dsm_setting(Cap OWNER voxels METHOD Capping TYPE bool DEFAULT 0
  LABEL "Cap" PANEL default GROUP cut
  TEXT "Show the faces where the clipping plane and the cropping box cut the data. The values on the faces determine
    their colors."
  DETAILS "Faces of isosurfaces look as slices do. Faces of the medium are unlit. vtkVolumeMapper's cropping regions
    have no such faces.")
dsm_setting(CapSide OWNER voxels TYPE enum DEFAULT 0
  ENTRIES ValuesAbove "Values Above" ValuesBelow "Values Below" WholeFace "Whole Face"
  LABEL "Cap Side" PANEL default GROUP cut WHEN isosurfaces DSMCap=1
  TEXT "Part of an isosurface's cut faces to show: values at or above the lowest isovalue, values at or below the
    highest isovalue, or the entire face.")
dsm_setting(CapOpacityFromMap OWNER voxels METHOD CapOpacity TYPE bool DEFAULT 1
  LABEL "Cap Opacity From Map" PANEL default GROUP cut WHEN volume DSMCap=1
  TEXT "Apply the opacity function to the cut faces of a volume. Off: the faces are opaque.")

dsm_setting(Scattering OWNER volume OWN_METHOD TYPE double DEFAULT 0.75 RANGE 0 1
  LABEL "Scattering" PANEL default ENABLED Shade=1 DSMShadows=1|DSMAmbientOcclusionSamples!=0 WHEN volume
  TEXT "Fraction of the shading that comes from light scattered once by the volume, while the view has shadows or
    ambient occlusion. Dense volumes are nearly black without it. 0 turns it off.")

dsm_setting(ExactIntegration OWNER volume TYPE bool DEFAULT 0
  LABEL "Exact Integration" PANEL advanced WHEN volume
  TEXT "Integrate the volume to a small part of a step of the picture's 8-bit channels, cell by cell. Off: take several
    cells at once where values bend so little that the picture does not show it."
  DETAILS "Off, pictures differ from exact ones by less than 0.25 of 255 on average. In the blend mode Composite.")

dsm_setting(SliceOpacityFromMap OWNER slices OWN_METHOD METHOD OpacityFromMap TYPE bool DEFAULT 0
  LABEL "Opacity From Map" PANEL default WHEN slices
  TEXT "Apply the opacity function to the values on the slices. The display's opacity multiplies the result.")
dsm_setting(SliceInterpolate OWNER slices METHOD InterpolateSlices TYPE bool DEFAULT 1
  LABEL "Interpolate Values" PANEL default WHEN slices
  TEXT "Interpolate values between samples. Off: each point has the color of the nearest sample. Cell values are never
    interpolated.")
dsm_setting(SliceLighting OWNER slices TYPE bool DEFAULT 0
  LABEL "Slice Lighting" PANEL default WHEN slices
  TEXT "Apply lighting to the slices. Off: the slices show the unmodified colors of the color map.")

dsm_setting(ShowEdges OWNER mesh OWN_METHOD TYPE bool DEFAULT 0
  LABEL "Show Edges" PANEL default
  TEXT "Draw the edges of polygons on the surface, as Surface With Edges does. Edge Color and Line Width set their
    look.")
dsm_setting(LineRadius OWNER mesh TYPE double DEFAULT 0
  LABEL "Line Radius" PANEL advanced
  TEXT "Radius of the tubes that lines are shown as, in the dataset's units. Their ends are round. 0 uses 1/300 of the
    dataset's diagonal. A negative number hides lines."
  DETAILS "The diagonal is that of all ranks' data.")
dsm_setting(PointRadius OWNER mesh TYPE double DEFAULT 0
  LABEL "Point Radius" PANEL advanced
  TEXT "Radius of the spheres that vertices are shown as, in the dataset's units. 0 uses 1/300 of the dataset's
    diagonal. A negative number hides vertices."
  DETAILS "The diagonal is that of all ranks' data.")
dsm_setting(RadiusArray OWNER mesh TYPE array ARRAYS input_array_point_1
  LABEL "Radius Array" PANEL advanced
  TEXT "Point array that scales the radii of tubes and spheres. Between the points of a line, the radius changes
    evenly."
  DETAILS "It has one component. Empty: none. Where it is negative or not a number, the radius is 0.")
