// The module depthgrid._core; depthgrid/__init__.py hands its names on.
#include <nanobind/nanobind.h>

#include "depthgrid/core/error.hpp"
#include "parts.hpp"

NB_MODULE(_core, module) {
  module.doc() = "The first level of depthgrid's C++ interface, over numpy arrays.";
  module.attr("version") = DEPTHGRID_VERSION;
  nanobind::exception<depthgrid::Error>(module, "Error", PyExc_ValueError);
  depthgrid::python::add_rig(module);
  depthgrid::python::add_answers(module);
  depthgrid::python::add_memory(module);
  depthgrid::python::add_evaluator(module);
}
