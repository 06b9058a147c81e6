/// @file The library for Python: Simulation with columns as NumPy arrays that share its memory, and run().
/// The package around it (mpmfast/__init__.py) is what is imported.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <optional>

#include "engine/library/simulation.hpp"

namespace {

namespace py = pybind11;
using namespace py::literals;
using namespace mpmfast;

/// A value inside of a list or a mapping, as JSON writes it, which YAML reads.
std::string nested_text(const py::handle& value);

std::string joined(const py::handle& items) {
  std::string out;
  for (const py::handle item : items) out += (out.empty() ? "" : ", ") + nested_text(item);
  return out;
}

/// True, None, a number or a list as YAML has them; nothing of text and what else there is.
std::optional<std::string> yaml_text(const py::handle& value) {
  if (py::hasattr(value, "tolist"))
    return yaml_text(value.attr("tolist")());  // a number or an array of NumPy
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (value.is_none()) return "none";
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) return "[" + joined(value) + "]";
  if (!py::isinstance<py::dict>(value)) {
    if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) return py::str(value);
    return std::nullopt;
  }
  std::string out;
  for (const auto& [key, item] : value.cast<py::dict>())
    out += (out.empty() ? "" : ", ") + nested_text(py::str(key)) + ": " + nested_text(item);
  return "{" + out + "}";
}

std::string nested_text(const py::handle& value) {
  if (const auto text = yaml_text(value)) return *text;
  return py::module_::import("json")
      .attr("dumps")(py::str(value), "ensure_ascii"_a = false)
      .cast<std::string>();
}

/// Text is YAML already.
Settings settings_from(const py::dict& set) {
  Settings settings;
  for (const auto& [path, value] : set) {
    const auto text = yaml_text(value);
    settings.emplace_back(py::str(path), text ? *text : std::string(py::str(value)));
  }
  return settings;
}

void warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

/// Lets Ctrl-C end what runs without the interpreter: what Python's own handler of the signal raises is kept
/// until that has ended.
class Interruption {
 public:
  bool came() {
    const py::gil_scoped_acquire acquire;
    if (!raised_ && PyErr_CheckSignals() != 0) raised_.emplace();
    return raised_.has_value();
  }

  void raise() {
    if (!raised_) return;
    raised_->restore();
    throw py::error_already_set();
  }

 private:
  std::optional<py::error_already_set> raised_;
};

/// A simulation that one thread at a time may use. The flag is read and set by who holds the interpreter.
class Shared {
 public:
  explicit Shared(Simulation simulation) : simulation_(std::move(simulation)) {
    for (const std::string& warning : simulation_.warnings()) warn(warning);
  }

  Simulation& use() {
    if (stepping_) throw std::runtime_error("the simulation is being advanced by another thread");
    return simulation_;
  }

  /// Runs f(simulation) without the interpreter.
  template <class F>
  auto step(F f) {
    Simulation& simulation = use();
    const Stepping guard(stepping_);
    const py::gil_scoped_release release;
    return f(simulation);
  }

 private:
  struct Stepping {
    explicit Stepping(bool& flag) : flag(flag) { flag = true; }
    ~Stepping() { flag = false; }
    bool& flag;
  };

  Simulation simulation_;
  bool stepping_ = false;
};

/// An array of the simulation's own memory, which it keeps alive. Nobody may write to it.
template <class T>
py::array_t<T> view_of(std::span<const T> values, const py::object& owner) {
  py::array_t<T> array(static_cast<py::ssize_t>(values.size()), values.data(), owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

Simulation& used(const py::object& self) { return self.cast<Shared&>().use(); }

/// A call of the library that only reads, as a method or a property.
template <class Result>
auto reads(Result (Simulation::*call)() const) {
  return [call](Shared& shared) { return (shared.use().*call)(); };
}

Simulation& with_column(Shared& shared, const std::string& name) {
  Simulation& simulation = shared.use();
  if (!simulation.has_column(name)) throw py::key_error("no column '" + name + "' in this scene");
  return simulation;
}

std::uint64_t advance_to(Shared& shared, double time) {
  Interruption interruption;
  const std::uint64_t steps = shared.step([&](Simulation& simulation) {
    return simulation.advance_to(time, [&] { return interruption.came(); });
  });
  interruption.raise();
  return steps;
}

py::dict energies_of(Shared& shared) {
  const Energies e = shared.use().energies();
  return py::dict("kinetic"_a = e.kinetic, "stored"_a = e.stored, "friction"_a = e.friction,
                  "dissipated"_a = e.dissipated, "boundary_work"_a = e.boundary_work,
                  "body_force_work"_a = e.body_force_work);
}

py::dict history_of(Shared& shared) {
  py::dict out;
  const std::vector<double> numbers = shared.use().history();
  std::size_t k = 0;
  for (const std::string& name : shared.use().history_columns()) out[py::str(name)] = numbers[k++];
  return out;
}

void add_velocity(Shared& shared, int axis,
                  const py::array_t<double, py::array::c_style | py::array::forcecast>& change) {
  if (change.ndim() != 1) throw std::invalid_argument("changes of velocity are one number a particle");
  shared.use().add_velocity(axis, {change.data(), static_cast<std::size_t>(change.size())});
}

py::object run_scene(const std::filesystem::path& scene, const std::filesystem::path& out,
                     const py::dict& set, bool force, int threads) {
  const Settings settings = settings_from(set);
  Interruption interruption;
  const Callbacks callbacks{.stop = [&] { return interruption.came(); },
                            .warn =
                                [](const std::string& text) {
                                  const py::gil_scoped_acquire acquire;
                                  warn(text);
                                }};
  std::string json;
  {
    const py::gil_scoped_release release;
    json = run(scene, out, settings, force, threads, callbacks);
  }
  interruption.raise();
  return py::module_::import("json").attr("loads")(json);
}

/// @param base  what Python's own of the kind is
py::object add_exception(py::module_& m, const char* name, PyObject* base, const char* meaning) {
  py::object made = py::exception<Error>(m, name, base);
  made.attr("__module__") = "mpmfast";
  made.attr("__doc__") = meaning;
  return made;
}

void add_exceptions(py::module_& m) {
  // Not destroyed at exit: the interpreter may be gone by then.
  static const auto* const errors = new std::map<Error::Kind, py::object>{
      {Error::Kind::misuse, py::reinterpret_borrow<py::object>(PyExc_ValueError)},
      {Error::Kind::scene,
       add_exception(m, "SceneError", PyExc_ValueError,
                     "The scene is wrong: every mistake with file, line, key and what was "
                     "expected.")},
      {Error::Kind::failure, add_exception(m, "RunFailure", PyExc_RuntimeError,
                                           "The run failed: step, time, particle, body and cause.")},
      {Error::Kind::file, add_exception(m, "FileError", PyExc_OSError,
                                        "A file could not be read or written, or is in the way.")}};
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      PyErr_SetString(errors->at(error.kind()).ptr(), error.what());
    }
  });
}

void add_stepping(py::class_<Shared>& simulation) {
  simulation
      .def_property_readonly("time", reads(&Simulation::time), "The time that the simulation has come to, s.")
      .def_property_readonly("end", reads(&Simulation::end), "The end of the scene, s.")
      .def_property_readonly("finished", reads(&Simulation::finished),
                             "Is the end reached? The last step may miss it by round-off.")
      .def_property_readonly("steps", reads(&Simulation::steps), "How many steps were taken.")
      .def_property_readonly("stable_dt", reads(&Simulation::stable_dt),
                             "The longest step that is stable now, s.")
      .def(
          "step", [](Shared& shared) { return shared.step([](Simulation& s) { return s.step(); }); },
          "Takes the next step that `mpmfast run` would take towards the end; returns its length, s, and 0 "
          "where the scene is finished.")
      .def(
          "advance",
          [](Shared& shared, double dt) { shared.step([&](Simulation& s) { return s.advance(dt); }); },
          py::arg("dt"), "One step of dt, s; longer than stable_dt it blows up.")
      .def("advance_to", &advance_to, py::arg("time"),
           "Steps as `mpmfast run --until` would until `time`, s; returns how many. Ctrl-C ends it between "
           "two "
           "steps.")
      .def("add_velocity", &add_velocity, py::arg("axis"), py::arg("change"),
           "Adds to the velocities along an axis, m/s, one number a particle in the order of the columns.");
}

void add_columns(py::class_<Shared>& simulation) {
  const auto columns = reads(&Simulation::columns);
  simulation.def("__len__", reads(&Simulation::particles), "How many particles there are.")
      .def_property_readonly("columns", columns, "Names of the columns: 'velocity.x', 'mass', ...")
      .def("keys", columns, "The same as columns.")
      .def(
          "__iter__", [columns](Shared& shared) { return py::iter(py::cast(columns(shared))); },
          "Over the names of the columns.")
      .def(
          "__contains__",
          [](Shared& shared, const py::object& name) {
            return py::isinstance<py::str>(name) && shared.use().has_column(name.cast<std::string>());
          },
          py::arg("column"), "Does the scene have this column?")
      .def(
          "__getitem__",
          [](const py::object& self, const std::string& name) {
            return view_of(with_column(self.cast<Shared&>(), name).column(name), self);
          },
          py::arg("column"),
          "One number a particle, read only: simulation['velocity.x']. It holds until the next step.")
      .def(
          "unit",
          [](Shared& shared, const std::string& name) { return with_column(shared, name).unit(name); },
          py::arg("column"), "Unit of a column: 'm/s', 'Pa', ...")
      .def_property_readonly(
          "ids", [](const py::object& self) { return view_of(used(self).ids(), self); },
          "Numbers of the particles, which they keep while the columns are sorted.")
      .def_property_readonly(
          "bodies", [](const py::object& self) { return view_of(used(self).bodies(), self); },
          "The body of each particle, into body_names.")
      .def_property_readonly("body_names", reads(&Simulation::body_names), "Names of the bodies.");
}

void add_figures(py::class_<Shared>& simulation) {
  simulation.def_property_readonly("dimension", reads(&Simulation::dimension), "2 or 3.")
      .def_property_readonly(
          "warnings", reads(&Simulation::warnings),
          "What in the scene is likely a mistake, as `mpmfast check` says it; warned of when it was read.")
      .def_property_readonly("energies", &energies_of,
                             "Where the energy is, J, a dict; in 2-D of the scene's thickness.")
      .def("history", &history_of,
           "The row of history.csv as it would stand now, a dict. Forces are means since the last call.")
      .def_property_readonly("checksum", reads(&Simulation::checksum),
                             "Of the particles' state, as in run.json.")
      .def_property_readonly("resolved_scene", reads(&Simulation::resolved_scene),
                             "The scene with every default, as scene.yaml has it.");
}

}  // namespace

PYBIND11_MODULE(_engine, m) {
  m.attr("__version__") = version();
  add_exceptions(m);
  py::class_<Shared> simulation(m, "Simulation",
                                "A scene that is stepped from here and writes no files. Everything is SI. "
                                "Arrays show the memory of the "
                                "simulation: they hold until the next step, which may sort the particles "
                                "anew; copy what is to be kept. "
                                "One thread at a time may use it.");
  simulation.attr("__module__") = "mpmfast";
  simulation
      .def(py::init([](const std::filesystem::path& scene, const py::dict& set, int threads) {
             return std::make_unique<Shared>(Simulation(scene, settings_from(set), threads));
           }),
           py::arg("scene"), py::arg("set") = py::dict(), py::arg("threads") = 0,
           "Reads a scene. set: {'time.cfl': 0.3, ...}; threads: of its steps, 0 for OMP_NUM_THREADS or the "
           "cores.")
      .def_static(
          "from_text",
          [](const std::string& yaml, const std::filesystem::path& folder, const py::dict& set, int threads) {
            return std::make_unique<Shared>(Simulation::from_text(yaml, folder, settings_from(set), threads));
          },
          py::arg("yaml"), py::arg("folder") = ".", py::arg("set") = py::dict(), py::arg("threads") = 0,
          "Reads a scene from text; relative paths in it count from folder.");
  add_stepping(simulation);
  add_columns(simulation);
  add_figures(simulation);

  m.def("run", &run_scene, py::arg("scene"), py::arg("out"), py::arg("set") = py::dict(),
        py::arg("force") = false, py::arg("threads") = 0,
        "Runs a scene into the folder `out` as `mpmfast run` does; returns run.json as a dict. force "
        "replaces the "
        "run in a folder that is there. After Ctrl-C the run is stopped, with a checkpoint.");
}
