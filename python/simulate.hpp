#pragma once

#include <incise/storage/case_file.hpp>

#include <pybind11/pybind11.h>

#include <filesystem>

namespace incise::python {

/// Runs a study up to the first simulated cut on a folder of results, with the interpreter free for other threads
/// meanwhile.
/// @returns the summary of `incise simulate --json`, and arrays: see incise.pyi.
/// @throws CaseError, DataError; the Python exception of a signal handler (KeyboardInterrupt) when one asked to stop.
[[nodiscard]] pybind11::dict simulate(const CaseFile& file, const std::filesystem::path& output, int threads);

}  // namespace incise::python
