#pragma once

#include "blob_folder.hpp"
#include "views.hpp"

#include <incise/core/monitor.hpp>
#include <incise/core/workers.hpp>
#include <incise/geometry/volume.hpp>
#include <incise/storage/case_file.hpp>
#include <incise/storage/run_folder.hpp>
#include <incise/workflow/margin_room.hpp>
#include <incise/workflow/study.hpp>

#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

namespace incise::studio {

/// Returns the folder to which `lay` writes a path of that kind on the measured tissue, and its program. It is removed
/// when the case is run or registered again.
[[nodiscard]] std::filesystem::path laid_folder(const CaseFile& file, PathKind kind);
/// Removes the laid paths of both kinds. @throws DataError for a folder that is not incise's own.
void remove_laid(const CaseFile& file);
/// Removes laid paths that were made from another state of the case.
void remove_stale_laid(const CaseFile& file);

/// The browser's requests; each makes a few calls of the library: see docs/decisions/0009-studio.md. The state is in
/// the case folder; only the CT read last and the tissue found last are kept in memory.
class Calls {
 public:
  using Json = nlohmann::ordered_json;
  /// Callbacks for events that a Monitor does not report.
  struct Watchers {
    std::function<void(const std::string&)> on_part;  ///< the current cut of a run: "pass 2 of at most 3"
    std::function<void(const Json&)> on_moment;       ///< the event `moment` of docs/decisions/0009-studio.md
  };
  Calls(const std::filesystem::path& blobs, Monitor& monitor, Watchers watchers);

  /// Makes the call of that name. @param file  the case; empty: none is open.
  /// @throws CaseError for an unknown call or for arguments that it cannot use; whatever the library throws.
  [[nodiscard]] Json make(const std::string& name, const std::filesystem::path& file, const Json& arguments);

 private:
  /// @throws StaleRevision if the caller refers to another case than the open one.
  void require_open(const Json& arguments) const;
  Json open(const Json& arguments);
  Json create(const Json& arguments);
  Json demo(const Json& arguments);
  Json show_case(const Json& arguments);
  Json change(const Json& arguments);
  Json scan(const Json& arguments);
  Json tissue(const Json& arguments);
  Json edge(const Json& arguments);
  Json room(const Json& arguments);
  Json body(const Json& arguments);
  Json stretch(const Json& arguments);
  Json plan(const Json& arguments);
  Json run(const Json& arguments);
  // After the cut: after_cut_calls.cpp.
  Json picture(const Json& arguments);
  Json photograph(const Json& arguments);
  Json frame(const Json& arguments);
  Json virtual_cloud(const Json& arguments);
  Json register_cloud(const Json& arguments);
  Json lay(const Json& arguments);
  Json unregister(const Json& arguments);
  Json arm(const Json& arguments);
  Json report(const Json& arguments);

  [[nodiscard]] RunContext context(std::uint64_t seed = 1) const;
  /// Returns the cautions that a person accepts for the current case. @throws StaleRevision for those of another
  /// revision.
  [[nodiscard]] std::vector<std::string> accepted_in(const Json& arguments) const;
  [[nodiscard]] const CtVolume& ct_of(const CaseFile& file);
  /// The tissue found in a case's scan or labels by its settings, its skin, and the meanings of the labels' values.
  struct Found {
    Segmentation tissue;
    TriMesh skin;
    Json given_labels;
  };
  [[nodiscard]] const Found& found_in(const CaseFile& file);
  /// The skin of a case's specimen at rest.
  [[nodiscard]] PlacedSkin skin_at_rest(const CaseFile& file);
  /// Refuses a case whose files cannot be read. @param is_made_later  true: its mesh does not exist yet.
  /// @throws DataError
  void require_readable(const CaseFile& made, bool is_made_later);
  /// Runs the case up to a stage, in its own output folder.
  [[nodiscard]] Study study_until(Stage until);
  void show_moment(const std::string& cut, const TissueModel& model, const IncisionProgress& progress);
  void send_moment(const std::string& cut, const TissueModel& model, const CutState& state);

  BlobFolder blobs_;
  Monitor& monitor_;
  Watchers watchers_;
  Workers workers_{0};
  std::filesystem::path file_;  ///< of the case
  std::string ct_key_;          ///< identifies the kept CT: its place, how it was read, and when it was changed
  CtVolume ct_;
  Verdict of_scan_;        ///< result of check_scan
  std::string found_key_;  ///< identifies found_: case file, its content, and scan or labels
  Found found_;
  std::chrono::steady_clock::time_point last_moment_{};
  double moment_cost_s_ = 0.0;  // of the last picture
  bool shows_moments_ = true;
};

}  // namespace incise::studio
