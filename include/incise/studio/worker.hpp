#pragma once

#include <filesystem>

namespace incise::studio {

/// Runs the studio's worker: reads one call per line from standard input and answers with lines on standard output,
/// until the input ends. All other output goes to standard error.
///
///   in   {"id": 7, "call": "tissue", "case": "/…/case.yaml", "with": {…}}
///   out  {"id": 7, "progress": {"stage": "cutting", "fraction": 0.4, "left_s": 9}}        any number
///        {"id": 7, "message": {"severity": "warning", "text": "…"}}                      any number
///        {"id": 7, "moment": {…}}                                                        of a cut under way
///        {"id": 7, "result": {…}}, {"id": 7, "problem": {…}} or {"id": 7, "stopped": "…"} last
///
/// Calls, results and problems are specified in docs/decisions/0009-studio.md. SIGINT stops the running call as Ctrl-C
/// stops the command: a cut leaves its checkpoint. When the parent process ends, the worker is interrupted, too.
/// @param blobs  existing folder for the arrays of results.
/// @returns the exit status.
int run_worker(const std::filesystem::path& blobs);

}  // namespace incise::studio
