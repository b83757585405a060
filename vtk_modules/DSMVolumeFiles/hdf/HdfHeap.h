// SPDX-License-Identifier: BSD-3-Clause
#ifndef vol_HdfHeap_h
#define vol_HdfHeap_h

#include <hdf5.h>

#include <cstddef>

namespace vol
{

/// Throws dsm::Error, which names file, object and attribute, where the global heap does not have
/// the texts, or the lists of references, of an attribute whose elements are of variable length
/// ("HDF5 File Format Specification", III.E). The library (1.10) follows the sizes in a damaged
/// heap beyond its memory, or without an end. To be called before it reads the attribute. `count`:
/// elements. Under the lock.
void CheckHdfHeap(hid_t attribute, std::size_t count);

} // namespace vol

#endif
