#pragma once

#include <incise/imaging/segmentation.hpp>
#include <incise/mechanics/statics.hpp>
#include <incise/workflow/products.hpp>

#include <optional>
#include <string>

namespace incise {

/// Identity of a product: its name, the digest of what determines it, and how long it took to make.
struct ProductNote {
  std::string name;  ///< labels, mesh, stretched, plan, as_planned, correction, corrected
  std::string key;
  double wall_s = 0.0;
};

/// Receives each product of a run when it is available, made or found in the cache: for files that people look at. The
/// default does nothing.
class ProductSink {
 public:
  virtual ~ProductSink() = default;
  virtual void labels(const ProductNote&, const Segmentation&) {}
  virtual void mesh(const ProductNote&, const MeshProduct&) {}
  virtual void stretched(const ProductNote&, const TissueModel&, const StaticResult&) {}
  virtual void plan(const ProductNote&, const ToolPath&) {}
  virtual void cut(const ProductNote&, const TissueModel&, const StaticResult&, const SimulatedCut&) {}
  virtual void correction(const ProductNote&, const Correction&) {}
  virtual void absent(const std::string& /*name*/) {}  ///< the run has no such product: remove an earlier run's
  /// Receives the verdicts on the cuts along the planned and the corrected path.
  /// @param of_planned    absent: the first cut did not follow the plan.
  /// @param of_corrected  absent: there is no corrected path.
  virtual void verdicts(const std::optional<Verdict>& of_planned, const std::optional<Verdict>& of_corrected) {
    static_cast<void>(of_planned), static_cast<void>(of_corrected);
  }
};

}  // namespace incise
