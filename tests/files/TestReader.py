# SPDX-License-Identifier: BSD-3-Clause
"""DSM Volume Reader in ParaView: its arrays look and filter like ordinary ones, and are read in parts. Called as
run.py does, with the folder of make_files.py behind the other arguments."""

import gc
import os
import shutil
import sys

from dsm_testing import *

FILES = sys.argv[3]
os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", str(get_ranks()))

load_plugin()
view = create_view()

COPY = """
from vtkmodules.vtkCommonDataModel import vtkImageData
data = self.GetInputDataObject(0, 0)
output = self.GetOutputDataObject(0)
output.CopyStructure(data)
# Of cells, too: those that other ranks have are marked.
for arrays, copies in ((data.GetPointData(), output.GetPointData()), (data.GetCellData(), output.GetCellData())):
    for index in range(arrays.GetNumberOfArrays()):
        array = arrays.GetArray(index)
        copy = array.NewInstance()
        copy.DeepCopy(array)
        copies.AddArray(copy)
output.GetPointData().SetActiveScalars(data.GetPointData().GetScalars().GetName())
"""
EXTENT = """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
source = self.GetInputInformation(0, 0)
target = self.GetOutputInformation(0)
for key in (Pipeline.WHOLE_EXTENT(),):
    target.CopyEntry(source, key)
"""


def ordinary(source):
    """The same in arrays of memory."""
    copy = simple.ProgrammableFilter(Input=source)
    copy.Script = COPY
    copy.RequestInformationScript = EXTENT
    copy.CopyArrays = 0
    return copy


def picture(source, array, **properties):
    display = show(source, view, [0.7], array, **properties)
    place_camera(view)
    pixels = render(view)
    simple.Hide(source, view)
    return pixels, display


# A state of an earlier version asks for an array without a name by the name that it had then.
old = simple.DSMVolumeReader(FileName=os.path.join(FILES, "ball.mha"), PointArrays=["values"])
old.UpdatePipeline()
check([array.GetName() for array in old.PointData] == ["values"], "the name that a state asks for")
simple.Delete(old)

pictures = []
BALLS = (
    ("ball.h5", "f"), ("ball.zarr", "ball"), ("ball.mha", "ball"), ("ball.vtkhdf", "f"), ("ball_zstd.vtkhdf", "f"),
    ("ball_deflate.vtkhdf", "f"))
for name, array in BALLS:
    source = simple.DSMVolumeReader(FileName=os.path.join(FILES, name))
    plain = ordinary(source)
    for organization in ("Replicated", "Object based", "Page based"):
        traced, _ = picture(source, array, DSMMemoryOrganization=organization)
        check(get_covered(traced).mean() > 0.05, f"{name}, {organization}: something is shown")
        expected, _ = picture(plain, array, DSMMemoryOrganization=organization)
        check((traced == expected).all(), f"{name}, {organization}: as from memory, bit for bit")
        pictures.append(traced)
    source.UpdatePipeline()
    low, high = source.PointData[array].GetRange(0)
    check(0 < low < 0.1 and abs(high - 3**0.5) < 1e-6, f"{name}: the range of its values")
    simple.Delete(plain)
    simple.Delete(source)
check(all((one == pictures[0]).all() for one in pictures), "all formats and organisations look alike")
reference = os.path.join(OUTPUT, "Reader.npy")
if get_ranks() == 1:
    numpy.save(reference, pictures[0])
else:
    check_equal(pictures[0], numpy.load(reference), "the picture is what one rank draws")

# Packed values on levels that are not evenly spaced, of which all ranks have a part.
source = simple.DSMVolumeReader(FileName=os.path.join(FILES, "ball.nc"))
plain = ordinary(source)
traced, _ = picture(source, "f")
check(source.GetDataInformation().GetDataSetTypeAsString() == "vtkRectilinearGrid", "its levels are not evenly spaced")
check(get_covered(traced).mean() > 0.01, "ball.nc: something is shown")
expected, _ = picture(plain, "f")
check((traced == expected).all(), "ball.nc: as from memory, bit for bit")
check(source.GetDataInformation().GetBounds() == (-1, 1, -1, 1, -numpy.sinh(2), numpy.sinh(2)), "ball.nc: its place")
simple.Delete(plain)
source.Spacing, source.Origin, source.OwnOrigin = [2, 3, 4], [5, 6, 7], 1
source.UpdatePipeline()
check(source.GetDataInformation().GetBounds() == (5, 99, 6, 123, 7, 147), "ball.nc: where the user places it")
simple.Delete(source)

# Depths lie where ParaView's own reader has them.
theirs = simple.NetCDFReader(FileName=[os.path.join(FILES, "ocean.nc")], Dimensions="(deptht, nav_lat, nav_lon)",
                             SphericalCoordinates=0)
ours = simple.DSMVolumeReader(FileName=os.path.join(FILES, "ocean.nc"))
with Messages() as messages:
    bounds = [source.GetDataInformation().GetBounds() for source in (theirs, ours) if source.UpdatePipeline() is None]
check(numpy.allclose(*bounds) and bounds[1][5] == -5, f"ocean.nc: as in ParaView's own reader: {bounds}")
check(messages.text == "", f"ocean.nc: degrees beside meters are ordinary: {messages.text}")

# Values that an attribute declares missing are as NaN: in pictures, in the range, and for the suggested isovalue.
def show_missing(name, array, isovalue, in_memory=0):
    source = simple.DSMVolumeReader(FileName=os.path.join(FILES, name), ValuesInMemory=in_memory)
    display = show(source, view, [isovalue], array)
    place_camera(view)
    pixels = render(view)
    display.DSMIsoValues = []
    simple.Render(view)
    display.UpdatePropertyInformation()
    found = pixels, source.PointData[array].GetRange(0), display.GetPropertyValue("DSMSuggestedIsoValue")
    simple.Delete(source)
    return found


MISSING = (("nan", 0.7, (("missing.h5", "float"), ("missing.h5", "double"), ("missing_float.zarr", "missing_float"))),
           ("whole nan", 70.5, (("missing.h5", "short"), ("missing.h5", "byte"),
                                ("missing_short.zarr", "missing_short"),
                                ("missing.h5", "ranged"), ("missing.h5", "two"), ("missing.h5", "ranged", 1),
                                ("missing.h5", "two", 1))))
for reference_name, isovalue, arrays in MISSING:
    expected, range_, suggested = show_missing("missing.h5", reference_name, isovalue)
    check(get_covered(expected).mean() > 0.05, f"{reference_name}: something is shown")
    for name, array, *in_memory in arrays:
        traced, found_range, found = show_missing(name, array, isovalue, *in_memory)
        check_equal(traced, expected, f"{name}, {array}: as NaN")
        check(numpy.allclose(found_range, range_), f"{name}, {array}: the range of its values: {found_range}, {range_}")
        check(abs(found - suggested) < 1e-3, f"{name}, {array}: the isovalue that NaN suggest: {found}, {suggested}")

# What dsm_convert writes is ParaView's own, too.
for name in ("ball.vtkhdf", "ball_deflate.vtkhdf"):
    theirs = simple.VTKHDFReader(FileName=os.path.join(FILES, name))
    ours = simple.DSMVolumeReader(FileName=os.path.join(FILES, name))
    same = (picture(theirs, "f")[0] == picture(ours, "f")[0]).all()
    check(same, f"{name}: ParaView's own reader gives the same picture")
    simple.Delete(theirs)
    simple.Delete(ours)

# What filters of ParaView make of it is what they make of an array in memory.
source = simple.DSMVolumeReader(FileName=os.path.join(FILES, "ball.h5"))
plain = ordinary(source)


def outcome(filter_, array):
    filter_.UpdatePipeline()
    information = filter_.GetDataInformation()
    arrays = filter_.PointData if array in filter_.PointData.keys() else filter_.CellData
    found = (
        information.GetNumberOfPoints(),
        information.GetNumberOfCells(),
        arrays[array].GetRange(0) if array else None,
    )
    simple.Delete(filter_)
    return found


def calculate(source):
    filter_ = simple.Calculator(Input=source)
    filter_.Function = "f * 2 + coordsX"
    return outcome(filter_, "Result")


def extract(source):
    filter_ = simple.ExtractSubset(Input=source)
    filter_.VOI = [5, 15, 6, 16, 7, 17]
    return outcome(filter_, "f")


def contour(source):
    filter_ = simple.Contour(Input=source, ContourBy=["POINTS", "f"], Isosurfaces=[0.7])
    return outcome(filter_, "f")


def cut(source):
    filter_ = simple.Slice(Input=source)
    filter_.SliceType.Origin = [20.0, 20.0, 17.5]
    # VTK 9.6 cuts into triangles only arrays of the types that it knows; docs/limits.md says so.
    filter_.Triangulatetheslice = int(simple.GetParaViewVersion() < (6, 0))
    return outcome(filter_, "f")


def gradient(source):
    filter_ = simple.Gradient(Input=source)
    filter_.ScalarArray = ["POINTS", "f"]
    return outcome(filter_, "Gradient")


def threshold(source):
    filter_ = simple.Threshold(Input=source)
    filter_.Scalars = ["POINTS", "f"]
    filter_.LowerThreshold, filter_.UpperThreshold = 0.2, 0.6
    return outcome(filter_, "f")


def line(source):
    filter_ = simple.PlotOverLine(Input=source)
    filter_.Point1, filter_.Point2 = [1.0, 2.0, 3.0], [40.0, 30.0, 30.0]
    return outcome(filter_, "f")


def describe(source):
    """Takes values out of the array through VTK's iterator."""
    filter_ = simple.DescriptiveStatistics(Input=source, ModelInput=None)
    filter_.VariablesofInterest = ["f"]
    filter_.UpdatePipeline()
    of_model = filter_.SMProxy.GetOutputPort(0).GetDataInformation().GetRowDataInformation()
    found = [of_model.GetArrayInformation(name).GetComponentRange(0) for name in ("Minimum", "Maximum", "Mean")]
    simple.Delete(filter_)
    return found


for apply in (calculate, extract, contour, cut, gradient, threshold, line, describe):
    found, expected = apply(source), apply(plain)
    check(found == expected, f"{apply.__name__}: as of an array in memory: {found}, {expected}")

# A filter that arranges the samples anew has another image's; the values stay those of their numbers. One that makes
# more points than there are values has an error.
ARRANGE = """
data = self.GetInputDataObject(0, 0)
output = self.GetOutputDataObject(0)
output.SetDimensions(SIZE)
output.GetPointData().SetScalars(data.GetPointData().GetScalars())
"""
ARRANGED_EXTENT = """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
self.GetOutputInformation(0).Set(Pipeline.WHOLE_EXTENT(), [end for n in SIZE for end in (0, n - 1)], 6)
"""
WHOLE_INPUT = """
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
source = self.GetInputInformation(0, 0)
source.Set(Pipeline.UPDATE_EXTENT(), source.Get(Pipeline.WHOLE_EXTENT()), 6)
"""


def arrange(source, size):
    filter_ = simple.ProgrammableFilter(Input=source)
    filter_.CopyArrays = 0
    filter_.Script = f"SIZE = {size}" + ARRANGE
    filter_.RequestInformationScript = f"SIZE = {size}" + ARRANGED_EXTENT
    filter_.RequestUpdateExtentScript = WHOLE_INPUT
    return filter_


if get_ranks() == 1:
    x, y, z = (end + 1 for end in source.GetDataInformation().GetExtent()[1::2])
    for size in ([y, x, z], [z, y, x]):
        arranged, expected = arrange(source, size), arrange(plain, size)
        same = (picture(arranged, "f")[0] == picture(expected, "f")[0]).all()
        check(same, f"arranged as {size}: the picture is as of an array in memory")
        simple.Delete(arranged)
        simple.Delete(expected)
    with Messages() as messages:
        larger = arrange(source, [x, y, 2 * z])
        probe = simple.ProbeLocation(Input=larger)
        probe.ProbeType.Center = [1.5, 1.5, 1.5 * z]
        probe.UpdatePipeline()
    check(f"has values for {x * y * z} points" in messages.text and "ball.h5" in messages.text,
          f"more points than values: {messages.text}")
    simple.Delete(probe)
    simple.Delete(larger)

# Filters of images make room for values of the type that the pipeline has told them of. On several ranks VTK's read
# beyond their part, also of an image in memory.
if get_ranks() == 1:
    for name in ("ball.h5", "signed_char.h5", "shuffle_deflate.h5", "all_filters.h5", "vectors.h5"):
        image = simple.DSMVolumeReader(FileName=os.path.join(FILES, name))
        image.UpdatePipeline()
        shrunk = simple.ImageShrink(Input=image)
        shrunk.ShrinkFactors = [1, 1, 1]
        shrunk.UpdatePipeline()
        found, expected = (one.PointData[0].GetRange(0) for one in (shrunk, image))
        check(found == expected, f"{name} through a filter of images: {found}, {expected}")
        simple.Delete(shrunk)
        simple.Delete(image)

with Messages() as messages:
    missing = simple.DSMVolumeReader(FileName=os.path.join(FILES, "manifest.json"))
    missing.UpdatePipeline()
if get_ranks() == 1:
    check("manifest.json" in messages.text and "unknown format" in messages.text, "an error names the file")
image = simple.DSMVolumeReader(FileName=os.path.join(FILES, "image.vtkhdf"))
check(list(image.GetProperty("PointArrays").GetAvailable()) == ["f", "v"], "the panel lists the point arrays")
kinds = simple.DSMVolumeReader(FileName=os.path.join(FILES, "kinds.h5"))
kinds.UpdatePipeline()
offered = [*kinds.GetProperty("PointArrays").GetAvailable()]
check(offered[-2:] == ["E", "v"] and "E" not in kinds.PointData.keys() and "E/x" in kinds.PointData.keys(),
      f"vectors of named components are offered: {offered}")
kinds.PointArrays = ["E"]
kinds.UpdatePipeline()
check(kinds.PointData["E"].GetNumberOfComponents() == 3 and kinds.PointData["E"].GetRange(-1)[0] == 5**0.5,
      "and read where they are chosen")
simple.Delete(kinds)
check(list(image.GetProperty("CellArrays").GetAvailable()) == ["c"], "and the cell arrays")
image.UpdatePipeline()
check(image.PointData.keys() == ["f", "v"] and image.CellData.keys() == ["c"], "all of them are chosen at first")
image.PointArrays = ["v"]
image.UpdatePipeline()
check(image.PointData.keys() == ["v"] and image.CellData.keys() == ["c"], "what is no more chosen is not there")
image.FileName = [os.path.join(FILES, "scalars.vtkhdf")]
image.PointArrays = ["g"]
image.UpdatePipeline()
check(image.PointData.keys() == ["g"], "nor of another file")
image.FileName = [os.path.join(FILES, "scalars_text.vtkhdf")]
image.UpdatePipeline()
check(image.PointData.keys() == ["g"], "and what was chosen of a file holds for the same arrays of another")

with Messages() as messages:
    bare = simple.DSMVolumeReader(FileName=os.path.join(FILES, "bare.raw"))
    bare.UpdatePipelineInformation()
    check(messages.text == "", "a bare file may be opened before its sizes are entered")
    bare.UpdatePipeline()
    bare.UpdatePipeline()
if get_ranks() == 1:
    check(messages.text.count("ERR") == 1, f"and then an error asks for them, once: {messages.text}")
    check("Enter Raw Dimensions in the Properties panel" in messages.text, "and says where they are entered")
check(bare.GetProperty("RawFile").GetElement(0) == 1, "the panel shows what describes bare values")
bare.RawDimensions, bare.RawScalarType, bare.RawBigEndian = [21, 13, 10], "int", 1
bare.RawHeaderBytes = 21
bare.UpdatePipeline()
check(bare.PointData["bare"].GetRange(0) == (0, 100), "bare values, once they are described")
bare.RawDimensions, bare.RawScalarType = [21, 13, 40], "unsigned char"
bare.UpdatePipeline()
with Messages() as messages:
    bare.RawScalarType = "int"
    bare.UpdatePipeline()
if get_ranks() == 1:
    check("bytes" in messages.text, "more values than there are: an error says so")
with Messages() as messages:
    bare.RawDimensions = [21, 13, 10]
    bare.UpdatePipeline()
check("ERR" not in messages.text, f"once they are right again, there is none: {messages.text}")
check(bare.GetDataInformation().GetExtent() == (0, 20, 0, 12, 0, 9), "and all is as large as it should be")
check(bare.PointData["bare"].GetRange(0) == (0, 100), "with the values that are there")
with Messages() as messages:
    bare.RawDimensions = [21, 13, 9]
    bare.UpdatePipeline()
check(f"{21 * 13 * 4} bytes are not used after" in messages.text, f"what is left of the file is told: {messages.text}")
check(bare.GetDataInformation().GetExtent() == (0, 20, 0, 12, 0, 8), "and all else is shown")
check(bare.GetProperty("RawHeaderBytes").SMProperty.IsA("vtkSMIntVectorProperty"), "the panel has a field for a header")
for name in ("ome.zarr", "ome.zarr/.zattrs"):
    check(simple.OpenDataFile(os.path.join(FILES, name)).TimestepValues[-1] == 2, f"OME's times, by {name}")
scales = simple.DSMVolumeReader(FileName=os.path.join(FILES, "ome.zarr"), LevelofDetail=1)
scales.UpdatePipeline()
check(scales.GetDataInformation().GetExtent() == (0, 10, 0, 6, 0, 4), "scripts choose a level by its number")
check(scales.LevelofDetail == 1 and scales.GetProperty("RawFile").GetElement(0) == 0, "and read it back")
levels = ["0: 21 x 13 x 10", "1: 11 x 7 x 5"]
check(scales.GetProperty("LevelNames").GetElement(0).split("\n") == levels,
      "the panel lists the levels and their sizes")
with Messages() as messages:
    scales.LevelofDetail = 2
    scales.UpdatePipeline()
    scales.UpdatePipeline()
if get_ranks() == 1:
    check(messages.text.count("ERR") == 1, f"a level that the file lacks is one error: {messages.text}")
    check("has no level 2; valid levels are 0 to 1" in messages.text, "which lists those that it has")
check(scales.GetProperty("LevelNames").GetElement(0).split("\n") == levels, "and so does the panel")
for name in ("three_raw.zarr", "three_raw.zarr/zarr.json"):
    opened = simple.OpenDataFile(os.path.join(FILES, name))
    check(type(opened).__name__ == "DSMVolumeReader", f"version 3, by {name}")

# Of compressed slices that all together do not fit, each is unpacked for each brick: that is told.
view = create_view()
packed = simple.DSMVolumeReader(FileName=os.path.join(FILES, "large/packed.h5"))
with Messages() as messages:
    display = show(packed, view, [150.0], DSMMemory=24)
    render(view)
check("a brick needs up to" in messages.text, f"chunks that are large for the memory: {messages.text}")
display.DSMMemory = 0
for proxy in (display, packed, view):
    simple.Delete(proxy)

# What each of three ranks has read of its part is known to two, and to one; what is asked for itself has its own range.
def count_read():
    with open("/proc/self/io", encoding="utf-8") as text:
        return int(text.readline().split()[1])


if get_ranks() == 1:
    os.environ["XDG_CACHE_HOME"] = os.path.join(OUTPUT, "caches", "shares")
    shutil.rmtree(os.environ["XDG_CACHE_HOME"], ignore_errors=True)
    bare = os.path.join(OUTPUT, "Reader.raw")
    numpy.random.default_rng(7).random((96, 96, 96)).tofile(bare)
    parts = simple.DSMVolumeReader(FileName=bare, RawDimensions=[96] * 3, RawScalarType="double")
    parts.UpdatePipelineInformation()
    reader = parts.GetClientSideObject()
    read, ranges = {}, {}
    for number in (3, 2, 1):
        before = count_read()
        for piece in range(number):
            reader.Modified()
            reader.UpdatePiece(piece, number, 0)
            ranges[number, piece] = reader.GetOutput().GetPointData().GetArray(0).GetRange()
        read[number] = count_read() - before
    size = os.path.getsize(bare)
    check(read[3] >= size and max(read[2], read[1]) < size / 4, f"what was read once is known: {read} of {size} bytes")
    whole = min(ranges[3, piece][0] for piece in range(3)), max(ranges[3, piece][1] for piece in range(3))
    check(ranges[1, 0] == whole, f"the ranges of parts together: {ranges[1, 0]} is {whole}")
    reader.Modified()
    reader.UpdateExtent([0, 3, 0, 3, 0, 3])
    corner = reader.GetOutput().GetPointData().GetArray(0)
    values = [corner.GetTuple1(index) for index in range(64)]
    check(corner.GetRange() == (min(values), max(values)) != whole, f"that of a corner is its own: {corner.GetRange()}")
    simple.Delete(parts)

# A file that nobody shows any more is closed, and other programs may write to it.
def count_open(name):
    links = [os.path.join("/proc/self/fd", number) for number in os.listdir("/proc/self/fd")]
    return sum(os.path.basename(os.readlink(link)) == name for link in links if os.path.islink(link))


view = create_view()
closing = simple.DSMVolumeReader(FileName=os.path.join(FILES, "deflate.h5"))
display = show(closing, view, [50.0])
place_camera(view)
render(view)
check(count_open("deflate.h5") > 0, "a file that is shown is open")
for proxy in (display, closing, view):
    simple.Delete(proxy)
del display, closing, view, proxy
gc.collect()
simple.Render(create_view())
check(count_open("deflate.h5") == 0, "and closed when it is deleted")
