// The parts of the module, each in a file of its own.
#pragma once

#include <nanobind/nanobind.h>

namespace depthgrid::python {

/// Camera, Rig, sensor_models().
void add_rig(nanobind::module_& module);
/// Distances.
void add_answers(nanobind::module_& module);
/// Memory.
void add_memory(nanobind::module_& module);
/// SearchEvaluator.
void add_evaluator(nanobind::module_& module);

}  // namespace depthgrid::python
