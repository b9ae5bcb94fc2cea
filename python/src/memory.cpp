// What a memory is told.
#include <nanobind/stl/string.h>

#include <string>

#include "arrays.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/memory/settings.hpp"
#include "parts.hpp"

namespace depthgrid::python {
namespace {

using namespace nb::literals;

memory::MemorySettings memory_of(nb::handle low, nb::handle high, const std::string& start, double voxel_m,
                                 double thinnest_hidden_m) {
  memory::MemorySettings settings;
  settings.low_world = vector_of(low, "low");
  settings.high_world = vector_of(high, "high");
  settings.voxel_m = voxel_m;
  settings.thinnest_hidden_m = thinnest_hidden_m;
  if (start == "unknown") {
    settings.start = memory::StartUnknown{};
  } else if (start == "empty") {
    settings.start = memory::StartEmpty{};
  } else {
    fail("start is '", start, "'; it is 'unknown' or 'empty'");
  }
  memory::validate(settings);
  return settings;
}

}  // namespace

void add_memory(nb::module_& module) {
  nb::class_<memory::MemorySettings>(module, "Memory",
                                     "What was seen free is remembered for as long as nothing can have come there.")
      .def(
          "__init__",
          [](memory::MemorySettings* self, nb::object low, nb::object high, const std::string& start, double voxel_m,
             double thinnest_hidden_m) {
            new (self) memory::MemorySettings(memory_of(low, high, start, voxel_m, thinnest_hidden_m));
          },
          "low"_a, "high"_a, nb::kw_only(), "start"_a, "voxel_m"_a = 0.025, "thinnest_hidden_m"_a = 0.0,
          "Corners of the region, world frame, metres. start: 'unknown', or 'empty': declared that nothing is there.");
}

}  // namespace depthgrid::python
