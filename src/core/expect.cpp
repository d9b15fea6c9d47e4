#include <incise/core/direction.hpp>
#include <incise/core/expect.hpp>

#include <fmt/format.h>

#include <cmath>
#include <span>

namespace incise {

void Expect::operator()(bool is_valid, std::string_view field, double found, std::string_view expected) const {
  if (is_valid && std::isfinite(found)) return;
  violations_.push_back({std::string(field), fmt::format("{}", found), std::string(expected)});
}

std::string DescriptionCheck::place_of(const Field& field) {
  if (path_.empty()) return std::string(field.name);
  Level& in = path_.back();
  if (in.is_list) return fmt::format("{}[{}]", in.path, in.next++);
  return in.path.empty() ? std::string(field.name) : fmt::format("{}.{}", in.path, field.name);
}

std::size_t DescriptionCheck::begin_list(const Field& field, std::size_t size, std::size_t) {
  path_.push_back({place_of(field), true});
  return size;
}

void DescriptionCheck::number(const Field& field, double& value, const Range& range) {
  std::string place = place_of(field);
  if (!contains(range, value)) problems_.push_back({std::move(place), fmt::format("{}", value), describe(range)});
}

void DescriptionCheck::integer(const Field& field, std::int64_t& value, const Range& range) {
  std::string place = place_of(field);
  if (!contains(range, as_number(value, range)))
    problems_.push_back({std::move(place), fmt::format("{}", value), describe(range)});
}

void DescriptionCheck::block(const Field& field, const Block& block) {
  const bool is_list = field.name.empty() && !path_.empty() && path_.back().is_list;
  const std::string place = is_list ? path_.back().path : place_of(field);
  if (block.kind != Block::Kind::Double) return;
  const std::span<const double> values(static_cast<const double*>(block.data), block.count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (contains(block.range, values[i])) continue;
    problems_.push_back({fmt::format("{}[{}]", place, i), fmt::format("{}", values[i]), describe(block.range)});
    return;  // one for each list: it may be long
  }
  if (block.is_direction && !is_direction(values.first<3>()))
    problems_.push_back({place, fmt::format("{:g} {:g} {:g}", values[0], values[1], values[2]), kDirectionText});
}

}  // namespace incise
