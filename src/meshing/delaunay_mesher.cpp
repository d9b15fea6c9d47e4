// The only file that includes CGAL: it takes two minutes and 3 GB to compile, so keep everything else out of it.
#include "meshing/delaunay_mesher.hpp"

#include <incise/core/error.hpp>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/assertions_behaviour.h>
#include <CGAL/exude_mesh_3.h>
#include <CGAL/perturb_mesh_3.h>
#include <CGAL/refine_mesh_3.h>

#include <atomic>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

namespace incise::meshing_detail {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

constexpr std::size_t kCallsBetweenCancelChecks = 8192;

/// Silences CGAL, which prints ten lines for a failed check before it throws; the caller turns the exception into one
/// sentence. The handlers belong to the process, so they are set only once.
void quiet_checks() {
  static std::once_flag once;
  std::call_once(once, [] {
    const auto say_nothing = [](const char*, const char*, const char*, int, const char*) {};
    CGAL::set_error_handler(say_nothing);
    CGAL::set_warning_handler(say_nothing);
  });
}

Vec3 to_vec3(const Kernel::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}

/// Criterion field: a multiple of the requested edge length. Also checks for a request to stop.
struct ScaledSize {
  using FT = Kernel::FT;
  using Point_3 = Kernel::Point_3;
  using Index = Domain::Index;

  const DelaunayDomain* body;
  double factor;
  std::atomic<bool>* stop;
  std::size_t* calls;

  FT operator()(const Point_3& p, int, const Index&) const {
    if (++*calls % kCallsBetweenCancelChecks == 0 && body->is_cancelled && body->is_cancelled()) stop->store(true);
    return factor * body->edge_length_mm(to_vec3(p));
  }
};

Domain make_domain(const DelaunayDomain& body, const DelaunayCriteria& criteria, CGAL::Random& random) {
  const Vec3 low = body.box.min();
  const Vec3 high = body.box.max();
  const Kernel::Iso_cuboid_3 box(Kernel::Point_3(low.x(), low.y(), low.z()),
                                 Kernel::Point_3(high.x(), high.y(), high.z()));
  const double diagonal_mm = (high - low).norm();
  return Domain([&body](const Kernel::Point_3& p) { return body.is_inside(to_vec3(p)) ? 1 : 0; }, box,
                CGAL::parameters::relative_error_bound = 2.0 * criteria.surface_tolerance_mm / diagonal_mm,
                CGAL::parameters::p_rng = &random);
}

}  // namespace

struct DelaunayMesher::State {
  State(DelaunayDomain given_body, const DelaunayCriteria& given_criteria)
      : body(std::move(given_body)), criteria(given_criteria), domain(make_domain(body, criteria, random)) {}

  DelaunayDomain body;
  DelaunayCriteria criteria;
  CGAL::Random random{0};
  Domain domain;
  Complex complex;
};

DelaunayMesher::DelaunayMesher(DelaunayDomain domain, const DelaunayCriteria& criteria) {
  quiet_checks();
  state_ = std::make_unique<State>(std::move(domain), criteria);
}
DelaunayMesher::~DelaunayMesher() = default;
DelaunayMesher::DelaunayMesher(DelaunayMesher&&) noexcept = default;

RefineEnd DelaunayMesher::refine() {
  using namespace CGAL::parameters;
  CGAL::get_default_random() = CGAL::Random(0);  // a second run in the same process starts like the first
  State& s = *state_;
  std::atomic<bool> stop = false;
  std::size_t calls = 0;
  const ScaledSize facet_field{&s.body, s.criteria.facet_size_factor, &stop, &calls};
  const ScaledSize cell_field{&s.body, s.criteria.cell_size_factor, &stop, &calls};
  const Criteria wanted(facet_angle = s.criteria.facet_angle_deg, facet_size = facet_field,
                        facet_distance = s.criteria.facet_distance_mm,
                        cell_radius_edge_ratio = s.criteria.cell_radius_edge_ratio, cell_size = cell_field);

  const Domain::Index surface = s.domain.index_from_surface_patch_index({0, 1});
  std::vector<std::pair<Kernel::Point_3, Domain::Index>> start;
  for (const Vec3& p : s.body.surface_points) start.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), surface);
  s.complex.insert_surface_points(start.begin(), start.end());

  CGAL::Mesh_error_code ended = CGAL::CGAL_MESH_3_NO_ERROR;
  CGAL::refine_mesh_3(s.complex, s.domain, wanted, no_reset_c3t3(), no_perturb(), no_exude(), manifold(),
                      mesh_3_options(maximal_number_of_vertices = s.criteria.max_vertices,
                                     pointer_to_error_code = &ended, pointer_to_stop_atomic_boolean = &stop));
  if (ended == CGAL::CGAL_MESH_3_STOPPED) return RefineEnd::Cancelled;
  return ended == CGAL::CGAL_MESH_3_NO_ERROR ? RefineEnd::Done : RefineEnd::TooManyVertices;
}

bool DelaunayMesher::perturb(double sliver_bound_deg) {
  // No time limit: the result must not depend on the machine's speed. The search ends by itself.
  return CGAL::perturb_mesh_3(state_->complex, state_->domain, CGAL::parameters::time_limit = 0,
                              CGAL::parameters::sliver_bound = sliver_bound_deg) == CGAL::BOUND_REACHED;
}

bool DelaunayMesher::exude(double sliver_bound_deg) {
  return CGAL::exude_mesh_3(state_->complex, CGAL::parameters::time_limit = 0,
                            CGAL::parameters::sliver_bound = sliver_bound_deg) == CGAL::BOUND_REACHED;
}

std::size_t DelaunayMesher::tet_count() const {
  return state_->complex.number_of_cells_in_complex();
}

TetMesh DelaunayMesher::extract() const {
  const Complex& complex = state_->complex;
  TetMesh mesh;
  mesh.tets.reserve(tet_count());
  std::unordered_map<const void*, VertexId> ids;  // never iterated, so its order does not matter
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    Tet tet;
    for (int corner = 0; corner < 4; ++corner) {
      const auto vertex_handle = cell->vertex(corner);
      const auto [entry, is_new] = ids.try_emplace(&*vertex_handle, VertexId(mesh.vertices.size()));
      if (is_new) {
        const auto& p = vertex_handle->point();
        mesh.vertices.emplace_back(p.x(), p.y(), p.z());
      }
      tet[static_cast<std::size_t>(corner)] = entry->second;
    }
    mesh.tets.push_back(tet);
  }
  return mesh;
}

}  // namespace incise::meshing_detail
