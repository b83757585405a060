#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Shows that the suite finds faults that it found before: puts each of some mended faults back into the sources,
builds, and runs the test that has to fail.

    revert_mends.py [--build FOLDER] [NUMBER ...]

FOLDER is a build with tests (build beside the sources, unless it is told). Without numbers all faults are put back, one
after another. A source that has changed is put back as it was, also where this is interrupted; do not edit the sources
meanwhile. The test must pass before the fault is there, and fail with it. Exits with 1 if a fault is not found."""

import argparse
import collections
import os
import signal
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# What was mended, where; the text as it is, and with the fault; the programs to build; the test; and the cases or
# scripts of it that are enough (GTEST_FILTER, DSM_TEST_SCRIPTS).
Mend = collections.namedtuple("Mend", "what path text fault targets test cases", defaults=("",))
VOLUME_FILES = ["files_TestVolumeFiles"], "files.VolumeFiles"
MENDS = (
    # DSMCore
    Mend("ulimit -f ended a rank by a signal", "vtk_modules/DSMCore/memory/ScratchFile.cxx",
         "GetMostFileBytes()", "RLIM_INFINITY", ["unit_dsmcore"], "unit.dsmcore",
         "*Scratch*"),
    Mend("blocks of more than 4 GiB on a rank were counted wrongly", "vtk_modules/DSMCore/publish/BlockDirectory.cxx",
         "std::uint64_t sum = 0;", "std::uint32_t sum = 0;", ["unit_dsmcore"], "unit.dsmcore", "*Directory*"),
    Mend("blocks that come from a file were counted as resident", "vtk_modules/DSMCore/publish/BlockDirectory.cxx",
         "this->GetOwner(id) == owner && !this->FromSource", "this->GetOwner(id) == owner", ["unit_dsmcore"],
         "unit.dsmcore", "*Source*:*Disk*:*Scratch*:*Directory*"),
    Mend("ulimit -f ended a rank that shares memory by a signal", "vtk_modules/DSMCore/memory/HostSharedMemory.cxx",
         "if (fileBytes > GetMostFileBytes())", "if (false)", ["unit_dsmcore"], "unit.dsmcore", "HostSharedMemory*"),
    Mend("one member of a group held all blocks of an owner", "vtk_modules/DSMCore/publish/HostGroups.h",
         "id / this->GroupOf.size() % members", "id % members", ["unit_dsmcore"], "unit.dsmcore", "HostGroups*"),
    Mend("the end of a session waited for the other ranks", "vtk_modules/DSMCore/transport/MpiTransport.cxx",
         "ended.emplace_back(new Transmission(std::move(*this)));", "this->Close();", ["mpi_tests"],
         "mpi.Ranks.3"),
    # DSMRayTracing
    Mend("a rank that was idle got no tiles of others", "vtk_modules/DSMRayTracing/schedule/WorkStealingScheduler.cxx",
         "this->TakeFromEnd(this->Own.size() / 2)", "this->TakeFromEnd(0)", ["unit_frame"],
         "unit.frame", "*Scheduling*"),
    Mend("lights that differ between ranks were not noticed", "vtk_modules/DSMRayTracing/frame/SceneDigest.cxx",
         "digest.AddAll(kind.index(), isLoneHeadlight, direction, color, ambientColor);",
         "digest.AddAll(kind.index());", ["unit_frame"], "unit.frame",
         "*Digest*"),
    Mend("triangles whose corners are nowhere got a place in the order", "vtk_modules/DSMBricks/sorted/SortedCells.cxx",
         "canBeHit ? code : NoCode", "code",
         ["unit_mesh"], "unit.mesh"),
    # DSMVolumeFiles
    Mend("the sign of a MetaImage's spacing counted", "vtk_modules/DSMVolumeFiles/plain/MetaImageFile.cxx",
         "step = std::abs(step);", "step = step + 0.0 * std::abs(step);", *VOLUME_FILES),
    Mend("the values of an NRRD were looked for before the end of its header",
         "vtk_modules/DSMVolumeFiles/plain/NrrdFile.cxx", "values.Offset += values.Offset < 0 ? 0 : values.Least;",
         "values.Offset += 0;", *VOLUME_FILES),
    Mend("HeaderSize did not count where values follow a MetaImage's header",
         "vtk_modules/DSMVolumeFiles/plain/MetaImageFile.cxx",
         "values.Offset = values.Offset == 0 ? values.Least : values.Offset;", "values.Offset = values.Least;",
         *VOLUME_FILES),
    Mend("the values of a MetaImage that ends with its header were looked for",
         "vtk_modules/DSMVolumeFiles/plain/MetaImageFile.cxx", "if (lines.HasEnded())", "if (false)",
         ["files_TestDamagedFiles"], "files.DamagedFiles"),
    Mend("an empty file was called one of an unknown format", "vtk_modules/DSMVolumeFiles/open/OpenVolumeFile.cxx",
         "PositionedFile(path).GetBytes() == 0", "false", ["files_TestDamagedFiles"], "files.DamagedFiles"),
    # RenderingDSM
    Mend("images whose samples are nowhere were drawn", "vtk_modules/DSMBricks/build/LatticePlan.cxx",
         "    RefuseImpossiblePlace(piece);", "    (void)&RefuseImpossiblePlace;", ["unit_rendering"],
         "unit.rendering"),
    Mend("a color array that is not there was an error", "vtk_modules/RenderingDSM/data/vtkDSMMeshData.cxx",
         'this->Warning = array + " does not exist', 'this->Message = array + " does not exist',
         ["rendering_TestPolyDataMapper"], "rendering.PolyDataMapper"),
    # The plugin
    Mend("a cache of 0 was told again and again", "plugin/Representations/settings/vtkPVDSMSettingRange.h",
         "before != warned.end() && before->second.Options == options", "before != warned.end()", ["DSMRayTracer"],
         "paraview.Scripts.3", "Errors"),
    Mend("the first isosurface was of a vector", "plugin/Representations/domains/vtkSMDSMIsosurfaceArrayDomain.cxx",
         "array && array->GetNumberOfComponents() == 1", "array && array->GetNumberOfComponents() > 0",
         ["DSMRayTracer"],
         "paraview.Scripts.1", "Isovalue"),
    Mend("reflectivity was a property of all of a view", "vtk_modules/RenderingDSM/options/settings.cmake",
         "dsm_setting(Reflectivity OWNER dataset", "dsm_setting(Reflectivity OWNER scene", ["DSMRayTracer"],
         "paraview.Scripts.1", "Options"),
)


def build(folder, targets):
    run = subprocess.run(["cmake", "--build", folder, "--target", *targets], stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True, check=False)
    if run.returncode != 0:
        print(run.stdout[-3000:])
    return run.returncode == 0


def passes(folder, mend):
    """Whether the test passes; None where there is no such test."""
    environment = dict(os.environ)
    if mend.cases:
        environment["DSM_TEST_SCRIPTS" if "Scripts" in mend.test else "GTEST_FILTER"] = mend.cases
    pattern = f"^{mend.test}$".replace(".", "[.]")
    run = subprocess.run(["ctest", "--test-dir", folder, "-R", pattern, "--no-tests=error"], env=environment,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return None if "No tests were found" in run.stdout else run.returncode == 0


def try_out(folder, mend):
    """Says what happened, or None where the fault was found."""
    path = os.path.join(ROOT, mend.path)
    with open(path, encoding="utf-8") as source:
        before = source.read()
    if before.count(mend.text) != 1:
        return "the source has changed: its text is not there once; adapt it here"
    if not build(folder, mend.targets):
        return "the program cannot be built"
    if not passes(folder, mend):
        return "the test does not pass without the fault, or there is none"
    try:
        with open(path, "w", encoding="utf-8") as source:
            source.write(before.replace(mend.text, mend.fault))
        if not build(folder, mend.targets):
            return "with the fault, the program cannot be built"
        return "NOT FOUND" if passes(folder, mend) else None
    finally:
        with open(path, "w", encoding="utf-8") as source:
            source.write(before)
        build(folder, mend.targets)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(ROOT, "build"))
    parser.add_argument("numbers", type=int, nargs="*", metavar="NUMBER")
    arguments = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that sources are put back
    wrong = 0
    for number in arguments.numbers or range(1, len(MENDS) + 1):
        mend = MENDS[number - 1]
        answer = try_out(arguments.build, mend)
        wrong += answer is not None
        print(f"{number}: {mend.what}: {answer or 'found by ' + ' '.join([mend.test, mend.cases]).strip()}", flush=True)
    print("every fault is found" if wrong == 0 else f"{wrong} are not")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
