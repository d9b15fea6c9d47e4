#include <incise/core/described_json.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/contour_io.hpp>
#include <incise/io/json_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/io/path_io.hpp>
#include <incise/storage/robust_files.hpp>

namespace incise {
void write_robust(RunFolder& run, const RobustCorrection& robust, const std::filesystem::path& calibration,
                  double wall_s) {
  const std::filesystem::path folder = run.root() / "robust";
  require_replaceable(folder);
  AtomicFolder target(folder);
  const RobustCompensation& chosen = robust.compensation;
  write_tool_path(target.path() / "path.json", run.with_specimen(chosen.path));
  write_contour_vtp(target.path() / "path.vtp", entry_contour(chosen.path));
  nlohmann::ordered_json json = to_json(robust);
  json["calibration_sha256"] = sha256_of_file(calibration);
  json["corrected_offset_mm"] = robust.corrected_offset_mm;
  json["offset_mm"] = chosen.offset_mm;
  json["is_limited"] = chosen.is_limited;
  write_json(target.path() / "robust.json", json);
  run.write_manifest_to(target.path(), wall_s);
  target.commit();
}

void write_assessment(RunFolder& run, const nlohmann::ordered_json& assessment,
                      const std::filesystem::path& calibration, const std::filesystem::path& registration,
                      double wall_s) {
  const std::filesystem::path folder = run.root() / "assessment";
  require_replaceable(folder);
  AtomicFolder target(folder);
  nlohmann::ordered_json json = assessment;
  json["calibration_sha256"] = sha256_of_file(calibration);
  json["registration_sha256"] = sha256_of_file(registration);
  write_json(target.path() / "assess.json", json);
  run.write_manifest_to(target.path(), wall_s);
  target.commit();
}

}  // namespace incise
