#include "report/ring_fixture.hpp"

#include <incise/core/units.hpp>

#include <cmath>

namespace incise::testing {
namespace {

int cells(double length_mm, double cell_mm) {
  return static_cast<int>(std::lround(length_mm / cell_mm));
}

}  // namespace

RingFixture::RingFixture(double cell_mm)
    : mesh(make_block({60.0, 44.0, 12.0}, {cells(60.0, cell_mm), cells(44.0, cell_mm), cells(12.0, cell_mm)})) {}

Vec3 RingFixture::stretched(const Vec3& p) const {
  const double bulge = 1.6 * std::sin(units::kPi * p.x() / 60.0) * std::sin(units::kPi * p.y() / 44.0) * p.z() / 12.0;
  return {p.x() + 0.1 * p.x(), p.y() * (1.0 - 0.05 * std::sin(units::kPi * p.x() / 60.0)), p.z() + bulge};
}

Contour RingFixture::ring(const std::function<double(double)>& radius) const {
  Contour contour;
  for (int k = 0; k < kPoints; ++k) {
    const double angle = units::kPi / 2.0 + 2.0 * units::kPi * k / kPoints;
    contour.points.push_back(stretched(center + radius(angle) * Vec3(std::cos(angle), std::sin(angle), 0.0)));
  }
  return contour;
}
double RingFixture::tumor_radius(double angle) {
  return 9.0 + 0.8 * std::cos(3.0 * angle) + 0.5 * std::sin(2.0 * angle);
}

std::vector<ReportFrame> RingFixture::frames(int steps) const {
  const std::vector<std::uint8_t> on_skin = skin_faces(mesh);
  std::vector<ReportFrame> result{frame_of(mesh, on_skin, mesh.vertices, {})};
  result.back().phase = "rest";
  Points positions;
  for (const Vec3& p : mesh.vertices) positions.push_back(stretched(p));
  std::vector<std::uint8_t> is_live(mesh.tets.size(), 1);
  for (int k = 0; k <= steps; ++k) {
    const double done = 2.0 * units::kPi * k / steps;
    for (std::size_t t = 0; t < mesh.tets.size() && k > 0; ++t) {
      Vec3 middle = Vec3::Zero();
      for (const VertexId id : mesh.tets[t]) middle += 0.25 * mesh.vertices[id.index()];
      const Vec3 from_center = middle - center;
      double angle = std::atan2(from_center.y(), from_center.x()) - units::kPi / 2.0;
      angle -= 2.0 * units::kPi * std::floor(angle / (2.0 * units::kPi));
      const double off = from_center.head<2>().norm() - tumor_radius(angle + units::kPi / 2.0) - 5.0;
      if (angle <= done && std::abs(off) < 0.9 && middle.z() > 7.0) is_live[t] = 0;
    }
    result.push_back(frame_of(mesh, on_skin, positions, is_live));
    result.back().phase = k == 0 ? "stretched" : "cutting";
    result.back().time_s = 10.0 * k / steps + 1.0;
    const double angle = units::kPi / 2.0 + done;
    result.back().tool_tip_mm =
        stretched(center + (tumor_radius(angle) + 5.0) * Vec3(std::cos(angle), std::sin(angle), 0.0)) - Vec3(0, 0, 5);
  }
  return result;
}

ReportIncision RingFixture::incision(const std::string& name, double offset, double amplitude) const {
  const auto error = [&](double angle) {
    return offset + amplitude * std::cos(angle) + 0.15 * amplitude * std::cos(7.0 * angle);
  };
  ReportIncision result;
  result.name = name;
  result.closed_loop = true;
  result.negative_margin = true;
  result.measured_contour = "kerf mid-line";
  result.tumor_edge = ring(tumor_radius);
  result.intended_path = ring([](double a) { return tumor_radius(a) + 5.0; });
  result.incision = ring([&](double a) { return tumor_radius(a) + 5.0 + error(a); });
  for (int k = 0; k < kPoints; ++k) {
    result.signed_error_mm.push_back(error(units::kPi / 2.0 + 2.0 * units::kPi * k / kPoints));
    result.mean_abs_error_mm += std::abs(result.signed_error_mm.back()) / kPoints;
  }
  return result;
}

ReportAnimation RingFixture::animation(const std::string& name, int steps) const {
  ReportAnimation result{.name = name, .frames = frames(steps)};
  result.lines = {{LineKind::TumorEdge, ring(tumor_radius)},
                  {LineKind::IntendedPath, ring([](double a) { return tumor_radius(a) + 5.0; })},
                  {LineKind::CorrectedPath, ring([](double a) { return tumor_radius(a) + 5.6 - 0.5 * std::cos(a); })},
                  {LineKind::KerfMidLine, incision(name, 0.3, 0.6).incision}};
  return result;
}

CtPicture RingFixture::scan() const {
  CtPicture picture{.caption = "A block in air."};
  picture.ct.grid = {.size = {140, 108, 24}, .spacing_mm = {0.5, 0.5, 1.0}, .origin_mm = {-5.0, -5.0, -5.0}};
  picture.occupancy.grid = picture.ct.grid;
  for (int k = 0; k < 24; ++k) {
    for (int j = 0; j < 108; ++j) {
      for (int i = 0; i < 140; ++i) {
        const Vec3 p =
            picture.ct.grid.world_from_index({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        const bool is_tissue = p.x() > 0 && p.x() < 60 && p.y() > 0 && p.y() < 44 && p.z() > 0 && p.z() < 12;
        picture.ct.voxels.push_back(
            static_cast<std::int16_t>(is_tissue ? 50 + (i * 7 + j * 13 + k * 29) % 40 - 20 : kAirHu));
        picture.occupancy.voxels.push_back(is_tissue ? 1.0F : 0.0F);
      }
    }
  }
  return picture;
}

ReportData RingFixture::data(int steps) const {
  ReportData data;
  data.title = "Ring around a virtual tumour";
  data.subtitle = "Test block, 60 × 44 × 12 mm";
  data.virtual_notice = "Virtual specimen: no real tissue was cut";
  data.ct = scan();
  data.mesh.mesh = mesh;
  data.mesh.min_dihedral_deg = 45.0;
  data.mesh.max_dihedral_deg = 90.0;
  data.mesh.volume_mm3 = 60.0 * 44.0 * 12.0;
  data.mesh.dihedral_angles = {.quantity = "dihedral angle", .unit = "°"};
  for (int k = 0; k < 36; ++k)
    data.mesh.dihedral_angles.counts.push_back(4000.0 * std::exp(-std::pow((k - 13.0) / 5.0, 2)));
  data.incisions = {incision("Before", -0.9, 1.6), incision("After", 0.1, 0.5)};
  data.incisions.back().corrected_path = ring([](double a) { return tumor_radius(a) + 5.6 - 0.5 * std::cos(a); });
  data.animations = {animation("Before compensation", steps), animation("After compensation", steps)};
  data.evaluation = {{"mean absolute error", "mm", 1.13, 0.31},
                     {"largest absolute error", "mm", 2.7, 0.71},
                     {"Hu score", "", 0.34, 0.021},
                     {"centroid shift", "mm", std::nullopt, 0.12}};
  data.stages = {{"mesh", "done", 4.21}, {"simulate", "resumed", 61.5}};
  data.program = {{"format", "urscript", ""}, {"duration", "14.2", "s"}};
  data.checks = {{"tip speed", "mm/s", 7.0, "<=", 250.0, true},
                 {"smallest singular value", "", 0.02, ">=", 0.05, false}};
  data.program_text = "def incise():\n  movel(p[0.1, 0.2 < 0.3])\nend\n";
  data.tables = {{"Calibration of speed and dullness",
                  {"speed, mm/s", "dullness", "score, %", "remark"},
                  {{"13", "9", "4.1", "chosen"}, {"10", "9", "6.3", ""}}}};
  data.settings = {{"cut.speed_mm_s", "13", "mm/s"}, {"cut.dullness", "9", "steps"}};
  data.provenance = {{"version", "0.1.0", ""}, {"seed", "1", ""}, {"threads", "2", ""}};
  data.files = {{"frames.pvd", "the cut, for ParaView"}};
  data.notices = {{Severity::Notice, "The platform is rigid."}, {Severity::Warning, "One <check> failed & is told."}};
  return data;
}

}  // namespace incise::testing
