/// @file The library for Python: Simulation with columns as NumPy arrays that share its memory, and run().

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>

#include "engine/library/simulation.hpp"

namespace {

namespace py = pybind11;
using namespace mpmfast;

/// Text as it is; numbers, lists and so on as YAML reads what Python prints of them.
Settings settings_from(const py::dict& set) {
  Settings settings;
  for (const auto& [path, value] : set) {
    const bool flag = py::isinstance<py::bool_>(value);
    settings.emplace_back(py::str(path),
                          flag ? (value.cast<bool>() ? "true" : "false") : std::string(py::str(value)));
  }
  return settings;
}

/// An array of the simulation's own memory, which it keeps alive. Nobody may write to it.
template <class T>
py::array_t<T> view_of(std::span<const T> values, const py::object& owner) {
  py::array_t<T> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::dict energies_of(Simulation& simulation) {
  const Energies e = simulation.energies();
  using namespace py::literals;
  return py::dict("kinetic"_a = e.kinetic, "stored"_a = e.stored, "friction"_a = e.friction,
                  "dissipated"_a = e.dissipated, "boundary_work"_a = e.boundary_work,
                  "body_force_work"_a = e.body_force_work);
}

py::dict history_of(Simulation& simulation) {
  py::dict out;
  const std::vector<double> numbers = simulation.history();
  std::size_t k = 0;
  for (const std::string& name : simulation.history_columns()) out[py::str(name)] = numbers[k++];
  return out;
}

void add_velocity(Simulation& simulation, int axis,
                  const py::array_t<double, py::array::c_style | py::array::forcecast>& change) {
  if (change.ndim() != 1) throw std::invalid_argument("changes of velocity are one number a particle");
  simulation.add_velocity(axis, {change.data(), static_cast<std::size_t>(change.size())});
}

py::object run_scene(const std::filesystem::path& scene, const std::filesystem::path& out,
                     const py::dict& set, bool force, int threads) {
  const Settings settings = settings_from(set);
  std::string json;
  {
    const py::gil_scoped_release release;
    json = run(scene, out, settings, force, threads);
  }
  return py::module_::import("json").attr("loads")(json);
}

}  // namespace

PYBIND11_MODULE(mpmfast, m) {
  m.doc() = "The material point method engine mpmfast: run scenes, or step them and read the particles.";
  m.attr("__version__") = version();

  // Not destroyed at exit: the interpreter may be gone by then.
  static const auto* const errors = new std::map<Error::Kind, py::object>{
      {Error::Kind::scene, py::exception<Error>(m, "SceneError", PyExc_ValueError)},
      {Error::Kind::failure, py::exception<Error>(m, "RunFailure", PyExc_RuntimeError)},
      {Error::Kind::file, py::exception<Error>(m, "FileError", PyExc_OSError)}};
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      PyErr_SetString(errors->at(error.kind()).ptr(), error.what());
    } catch (const std::out_of_range& error) {
      PyErr_SetString(PyExc_KeyError, error.what());
    }
  });

  py::class_<Simulation>(
      m, "Simulation",
      "A scene that is stepped from here and writes no files. Everything is SI. Arrays show the memory "
      "of the simulation: they hold until the next step, which may sort the particles anew.")
      .def(py::init([](const std::filesystem::path& scene, const py::dict& set) {
             return Simulation(scene, settings_from(set));
           }),
           py::arg("scene"), py::arg("set") = py::dict(), "Reads a scene; set: {'time.cfl': 0.3, ...}.")
      .def_static(
          "from_text",
          [](const std::string& yaml, const std::filesystem::path& folder, const py::dict& set) {
            return Simulation::from_text(yaml, folder, settings_from(set));
          },
          py::arg("yaml"), py::arg("folder") = ".", py::arg("set") = py::dict(),
          "Reads a scene from text; relative paths in it count from folder.")
      .def_property_readonly("dimension", &Simulation::dimension)
      .def_property_readonly("time", &Simulation::time, "s")
      .def_property_readonly("end", &Simulation::end, "s, of the scene")
      .def_property_readonly("steps", &Simulation::steps)
      .def_property_readonly("stable_dt", &Simulation::stable_dt, "s, of the next step")
      .def("__len__", &Simulation::particles)
      .def("advance", &Simulation::advance, py::arg("dt"), py::call_guard<py::gil_scoped_release>(),
           "One step of dt.")
      .def("advance_to", &Simulation::advance_to, py::arg("time"), py::call_guard<py::gil_scoped_release>(),
           "Steps as `mpmfast run` would until `time`; returns how many.")
      .def_property_readonly("columns", &Simulation::columns)
      .def(
          "__getitem__",
          [](const py::object& self, const std::string& name) {
            return view_of(self.cast<const Simulation&>().column(name), self);
          },
          py::arg("column"), "One number a particle, read only: simulation['velocity.x'].")
      .def("unit", &Simulation::unit, py::arg("column"))
      .def_property_readonly(
          "ids", [](const py::object& self) { return view_of(self.cast<const Simulation&>().ids(), self); },
          "A particle keeps its number while the columns are sorted.")
      .def_property_readonly(
          "bodies",
          [](const py::object& self) { return view_of(self.cast<const Simulation&>().bodies(), self); },
          "Of each particle, into body_names.")
      .def_property_readonly("body_names", &Simulation::body_names)
      .def("add_velocity", &add_velocity, py::arg("axis"), py::arg("change"),
           "Adds to the velocities along an axis, one number a particle.")
      .def_property_readonly("energies", &energies_of, "J")
      .def("history", &history_of,
           "The row of history.csv as it would stand now, a dict. Forces are means since the last call.")
      .def_property_readonly("checksum", &Simulation::checksum)
      .def_property_readonly("resolved_scene", &Simulation::resolved_scene);

  m.def("run", &run_scene, py::arg("scene"), py::arg("out"), py::arg("set") = py::dict(),
        py::arg("force") = false, py::arg("threads") = 0,
        "Runs a scene into the folder `out` as `mpmfast run` does; returns run.json as a dict.");
}
