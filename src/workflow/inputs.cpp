#include <incise/core/described_bytes.hpp>
#include <incise/core/sha256.hpp>
#include <incise/workflow/inputs.hpp>

namespace incise {

std::string Inputs::scan_digest(Monitor& monitor) {
  if (const std::optional<LabelVolume> labels = read_labels(monitor)) return sha256_of_text(bytes_of(*labels));
  return sha256_of_text(bytes_of(read_ct(monitor)));
}

}  // namespace incise
