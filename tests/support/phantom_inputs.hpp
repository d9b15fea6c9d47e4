#pragma once

#include <incise/imaging/phantom.hpp>
#include <incise/workflow/study.hpp>

#include <optional>

namespace incise::testing {

/// Gives a run the virtual specimen.
class PhantomInputs final : public Inputs {
 public:
  explicit PhantomInputs(const Phantom& phantom) : phantom_(phantom) {}
  CtVolume read_ct(Monitor&) override { return phantom_.ct; }
  std::optional<Contour> read_tumor_edge() override { return phantom_.tumor_edge; }

 private:
  const Phantom& phantom_;
};

}  // namespace incise::testing
