// Readers of cases and of the results that incise writes and takes up again.

#include "reader.hpp"

#include <incise/core/described_bytes.hpp>
#include <incise/cutting/incision_progress.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/json_file.hpp>
#include <incise/laboratory/bench_files.hpp>
#include <incise/laboratory/power_file.hpp>
#include <incise/storage/calibration_file.hpp>
#include <incise/storage/case_file.hpp>
#include <incise/storage/evaluation_file.hpp>
#include <incise/storage/published_table_file.hpp>
#include <incise/storage/registration_json.hpp>
#include <incise/storage/result_json.hpp>

namespace incise::fuzz {
namespace {

namespace fs = std::filesystem;

void study_case(const fs::path& file) {
  const CaseFile found = read_case(file);
  static_cast<void>(settings_of(found));
  static_cast<void>(settings_json(found));
}

void calibration(const fs::path& file) {
  const Calibration found = read_calibration(file);
  static_cast<void>(range_of(found));
  static_cast<void>(belief_of(found, file));
}

std::vector<Reader> all_readers() {
  return {
      {"case", "case", {"case.yaml"}, study_case},
      {"registration",
       "result",
       {"registration.json"},
       [](const fs::path& file) { static_cast<void>(read_registration(file)); }},
      {"calibration", "result", {"calibration.json"}, calibration},
      {"evaluation",
       "result",
       {"cut.json"},
       [](const fs::path& file) { static_cast<void>(read_evaluation_file(file)); }},
      {"photographed_cut",
       "result",
       {"cut.json"},
       [](const fs::path& file) { static_cast<void>(read_photographed_cut(file)); }},
      {"specimen", "result", {"specimen.json"}, [](const fs::path& file) { static_cast<void>(read_specimen(file)); }},
      {"published_table",
       "csv",
       {"table.csv"},
       [](const fs::path& file) { static_cast<void>(read_published_table(file)); }},
      {"timed_cuts", "csv", {"cuts.csv"}, [](const fs::path& file) { static_cast<void>(read_timed_cuts(file)); }},
      {"checkpoint",
       "checkpoint",
       {"checkpoint"},
       [](const fs::path& file) { static_cast<void>(from_bytes<IncisionProgress>(read_text(file), file)); }},
  };
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = all_readers();
  return all;
}

}  // namespace incise::fuzz
