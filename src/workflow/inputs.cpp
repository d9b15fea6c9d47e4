#include <incise/core/described_bytes.hpp>
#include <incise/core/sha256.hpp>
#include <incise/workflow/inputs.hpp>

namespace incise {

std::string Inputs::ct_digest(Monitor& monitor) {
  return sha256_of_text(bytes_of(read_ct(monitor)));
}

}  // namespace incise
