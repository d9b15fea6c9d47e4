#include "simulate.hpp"

#include <incise/core/error.hpp>
#include <incise/core/version.hpp>

#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

namespace {

namespace py = pybind11;
using namespace incise;

py::dict settings_dict(const CaseFile& file) {
  py::dict settings;
  for (const SettingLine& line : settings_of(file)) settings[py::str(line.key)] = line.value;
  return settings;
}

}  // namespace

PYBIND11_MODULE(incise, m) {
  py::module_::import("numpy");  // results need it: a missing one is found here, not after minutes of cutting
  m.doc() = "Plans robotic soft-tissue incisions by simulating them first. Lengths in mm, coordinates in LPS.";
  m.attr("__version__") = std::string(version());

  const auto error = py::register_exception<Error>(m, "Error", PyExc_RuntimeError);
  py::register_exception<InvalidArgument>(m, "InvalidArgument", error);
  py::register_exception<CaseError>(m, "CaseError", error);
  py::register_exception<DataError>(m, "DataError", error);

  py::class_<CaseFile>(m, "Case", "A case file as read: see load_case.")
      .def_readonly("file", &CaseFile::file)
      .def_readonly("folder", &CaseFile::folder)
      .def_property_readonly("title", [](const CaseFile& file) { return file.settings.title; })
      .def_property_readonly("settings", &settings_dict, "Every setting, defaults included: dotted key to text.");

  m.def("load_case", &read_case, py::arg("path"), "Reads case.yaml, or the file of that name in a folder.");
  m.def("simulate", &python::simulate, py::arg("case"), py::arg("output"), py::arg("threads") = 0,
        "Clamps, stretches, plans and cuts; resumes from what the folder `output` already holds.");
}
