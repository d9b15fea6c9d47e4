#include "simulate.hpp"

#include <incise/core/error.hpp>
#include <incise/io/json_file.hpp>
#include <incise/storage/result_json.hpp>
#include <incise/storage/run_folder.hpp>
#include <incise/workflow/study.hpp>

#include <pybind11/numpy.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <optional>
#include <thread>

namespace incise::python {
namespace {

namespace py = pybind11;

/// Asks Python now and then whether a signal arrived. Only the calling thread may ask; the workers see its answer.
class SignalMonitor : public Monitor {
 public:
  [[nodiscard]] bool is_cancelled() const override {
    constexpr std::chrono::milliseconds kInterval{50};
    if (std::this_thread::get_id() != owner_ || is_stopped_) return is_stopped_;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_asked_ < kInterval) return false;
    last_asked_ = now;
    const py::gil_scoped_acquire hold;
    if (PyErr_CheckSignals() != 0) {
      interruption_ = std::make_exception_ptr(py::error_already_set());
      is_stopped_ = true;
    }
    return is_stopped_;
  }

  /// Throws what the signal handler raised, if one did.
  void rethrow() const {
    if (interruption_) std::rethrow_exception(interruption_);
  }

 private:
  std::thread::id owner_ = std::this_thread::get_id();
  // Asking changes nothing that others can see but the answer.
  mutable std::chrono::steady_clock::time_point last_asked_{};
  mutable std::atomic<bool> is_stopped_ = false;
  mutable std::exception_ptr interruption_;
};

py::array_t<double> array_of(const Points& points) {
  py::array_t<double> array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  auto view = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < view.shape(0); ++i) {
    for (py::ssize_t k = 0; k < 3; ++k) view(i, k) = points[static_cast<std::size_t>(i)][k];
  }
  return array;
}

py::object array_or_none(const std::optional<Contour>& contour) {
  return contour ? py::object(array_of(contour->points)) : py::none();
}

py::array_t<std::int32_t> tets_of(const TetMesh& mesh) {
  py::array_t<std::int32_t> array({static_cast<py::ssize_t>(mesh.tets.size()), py::ssize_t{4}});
  auto view = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < view.shape(0); ++i) {
    for (py::ssize_t k = 0; k < 4; ++k)
      view(i, k) = mesh.tets[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)].value;
  }
  return array;
}

py::array_t<std::int32_t> removed_tets(const CutRecord& record) {
  py::array_t<std::int32_t> array(static_cast<py::ssize_t>(record.removals.size()));
  auto view = array.mutable_unchecked<1>();
  for (py::ssize_t i = 0; i < view.shape(0); ++i) view(i) = record.removals[static_cast<std::size_t>(i)].tet.value;
  return array;
}

py::dict dict_of(const nlohmann::ordered_json& json) {
  return py::module_::import("json").attr("loads")(json_text(json)).cast<py::dict>();
}

}  // namespace

py::dict simulate(const CaseFile& file, const std::filesystem::path& output, int threads) {
  if (threads < 0) throw InvalidArgument("simulate: expected threads >= 0 (0: all), found " + std::to_string(threads));
  SignalMonitor monitor;
  Study study;
  try {
    const py::gil_scoped_release release;
    require_plan_inputs(file);
    require_input_files(file);
    Workers workers(threads);
    RunFolder folder(file, output, {"incise.simulate (Python)", 1, workers.thread_count()});
    study = run_study(file.settings, folder, folder.cache(), {.until = Stage::Simulate}, workers, monitor, folder);
  } catch (const Cancelled&) {
    monitor.rethrow();
    throw;
  }
  monitor.rethrow();
  py::dict result = study.as_planned ? dict_of(to_json(*study.as_planned)) : dict_of(to_json(*study.stretched));
  result["outcome"] = py::str(std::string(to_string(study.outcome)));
  result["vertices_mm"] = array_of(study.model->mesh.vertices);
  result["stretched_mm"] = array_of(study.stretched->state.positions);
  result["tets"] = tets_of(study.model->mesh);
  result["removed_tets"] = study.as_planned ? py::object(removed_tets(study.as_planned->incision.record)) : py::none();
  result["centerline_mm"] = study.as_planned ? array_or_none(study.as_planned->incision.centerline) : py::none();
  result["inner_edge_mm"] = study.as_planned ? array_or_none(study.as_planned->incision.inner_edge) : py::none();
  return result;
}

}  // namespace incise::python
