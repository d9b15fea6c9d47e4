#include "support/refusal.hpp"

#include <incise/core/described_bytes.hpp>
#include <incise/core/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace incise {
namespace {

enum class Shape { Round, Square };
constexpr std::array<std::string_view, 2> kShapeNames{"round", "square"};
constexpr Names names_of(Shape) {
  return kShapeNames;
}

struct Inner {
  int count = 3;
  std::vector<Eigen::Vector3d> points;
};
void describe(Visitor& v, Inner& i) {
  v("count", i.count, "How many.", Range{0.0, 10.0});
  v("points", i.points, "Where.");
}

struct Outer {
  double length_mm = 1.5;
  bool is_new = true;
  std::string name = "a";
  Shape shape = Shape::Round;
  std::optional<double> width_mm;
  std::optional<Inner> last;
  std::vector<Inner> inner;
  std::array<std::size_t, 2> counts{};
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  std::vector<std::uint8_t> marks;
  std::vector<std::array<Id<struct TestTag>, 2>> edges;
  std::map<std::string, Inner> by_name;
};
void describe(Visitor& v, Outer& o) {
  v("length_mm", o.length_mm, "How long.", kPositive);
  v("is_new", o.is_new, "Whether.");
  v("name", o.name, "What.");
  v("shape", o.shape, "Which.");
  v("width_mm", o.width_mm, "How wide.");
  v("last", o.last, "The last.");
  v("inner", o.inner, "All.");
  v("counts", o.counts, "Two.");
  v("turn", o.turn, "Rotation.");
  v("marks", o.marks, "Marks.");
  v("edges", o.edges, "Edges.");
  v("by_name", o.by_name, "Named.");
}

Outer an_outer() {
  Outer o;
  o.length_mm = 0.1 + 0.2;
  o.is_new = false;
  o.name = "tongue";
  o.shape = Shape::Square;
  o.last = Inner{7, {{1, 2, 3}}};
  o.inner = {Inner{1, {}}, Inner{2, {{4, 5, 6}, {7, 8, 9}}}};
  o.counts = {5, 6};
  o.turn(0, 1) = -0.25;
  o.marks = {1, 0, 1};
  o.edges.emplace_back(
      std::array<Id<struct TestTag>, 2>{Id<struct TestTag>(std::size_t{3}), Id<struct TestTag>(std::size_t{4})});
  o.by_name["x"] = Inner{4, {}};
  return o;
}

TEST(DescribedBytes, GiveBackEveryFieldWithAllItsBits) {
  const Outer o = an_outer();
  const std::string bytes = bytes_of(o);
  const auto back = from_bytes<Outer>(bytes, "test");
  EXPECT_EQ(bytes_of(back), bytes);
  EXPECT_EQ(back.length_mm, o.length_mm);
  EXPECT_EQ(back.shape, Shape::Square);
  EXPECT_FALSE(back.width_mm);
  EXPECT_EQ(back.last->points.at(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(back.inner.at(1).points.at(1), Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(back.counts, o.counts);
  EXPECT_EQ(back.turn, o.turn);
  EXPECT_EQ(back.marks, o.marks);
  EXPECT_EQ(back.edges.at(0)[1].value, 4);
  EXPECT_EQ(back.by_name.at("x").count, 4);
}

TEST(DescribedBytes, GiveBackEveryUnsignedNumber) {
  constexpr std::uint64_t kLargestSigned = std::numeric_limits<std::int64_t>::max();
  for (const std::uint64_t seed : {kLargestSigned, kLargestSigned + 1, std::numeric_limits<std::uint64_t>::max()})
    EXPECT_EQ(from_bytes<std::uint64_t>(bytes_of(seed), "test"), seed);
}

TEST(DescribedBytes, DifferWhereAnyFieldDiffers) {
  const std::string bytes = bytes_of(an_outer());
  Outer other = an_outer();
  other.inner[0].count = 9;
  EXPECT_NE(bytes_of(other), bytes);
  other = an_outer();
  other.width_mm = 0.0;
  EXPECT_NE(bytes_of(other), bytes);
}

TEST(DescribedBytes, OfAnyOtherLengthAreRefused) {
  const std::string bytes = bytes_of(an_outer());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(static_cast<void>(from_bytes<Outer>(bytes.substr(0, size), "test")), DataError) << size;
  EXPECT_THROW(static_cast<void>(from_bytes<Outer>(bytes + "x", "test")), DataError);
}

TEST(DescribedBytes, AreRefusedWithPlaceAndField) {
  Outer o = an_outer();
  o.last->count = 11;
  EXPECT_THAT(testing::refusal_of<DataError>([&] { return from_bytes<Outer>(bytes_of(o), "entry"); }),
              ::testing::HasSubstr("count: found 11, expected a number in [0, 10]"));
}

TEST(DescribedBytes, TakeNoMoreMemoryThanTheBytesAllow) {
  std::string bytes = bytes_of(std::vector<double>{1.0});
  for (int i = 0; i < 8; ++i) bytes[static_cast<std::size_t>(i)] = '\x7f';  // the count
  EXPECT_THROW(static_cast<void>(from_bytes<std::vector<double>>(bytes, "test")), DataError);
}

struct Place {
  std::filesystem::path file;
  std::optional<Eigen::AlignedBox3d> box;
  Eigen::Vector3d towards = Eigen::Vector3d::UnitX();
  int margin = 4;
};
void describe(Visitor& v, Place& p) {
  v("file", p.file, "Where it lies.");
  v({"box_mm", "What it holds.", "mm"}, p.box);
  v.direction("towards", p.towards, "Where it points.");
  v.internal("margin", p.margin, "Around the box.");
}

TEST(DescribedBytes, HoldFilesBoxesDirectionsAndWhatNoFileSets) {
  const Place place{"a/b.csv", Eigen::AlignedBox3d(Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(4, 5, 6)), {0, 0, 2}, 7};
  const auto back = from_bytes<Place>(bytes_of(place), "test");
  EXPECT_EQ(back.file, place.file);
  EXPECT_EQ(back.box->min(), place.box->min());
  EXPECT_EQ(back.box->max(), place.box->max());
  EXPECT_EQ(back.towards, place.towards) << "with its length";
  EXPECT_EQ(back.margin, 7);
  EXPECT_TRUE(from_bytes<Place>(bytes_of(Place{}), "test").file.empty());
}

/// Is shown what there may be: every kind of item, and values that are absent.
class Examples : public ByteWriter {
 public:
  std::size_t begin_list(const Field& field, std::size_t, std::size_t) override {
    seen += fmt::format("{}[", field.name);
    return kEveryKind;
  }
  void end_list() override { seen += "]"; }
  bool optional(const Field&, bool is_there) override {
    seen += is_there ? "" : "?";
    return true;
  }
  void number(const Field& field, double&, const Range&) override { seen += fmt::format("{} ", field.name); }
  void choice(const Field&, std::size_t& value, Names names) override { seen += fmt::format("{} ", names[value]); }
  std::string seen;
};

struct Disc {
  double radius_mm = 1.0;
};
void describe(Visitor& v, Disc& d) {
  v("radius_mm", d.radius_mm);
}
struct Slab {
  std::optional<double> width_mm;
};
void describe(Visitor& v, Slab& s) {
  v("width_mm", s.width_mm);
}
Names names_of(const std::variant<Disc, Slab>&) {
  return kShapeNames;
}

TEST(Visitor, MayBeShownEveryKindOfItemAndWhatIsAbsent) {
  std::vector<std::variant<Disc, Slab>> none;
  Examples examples;
  examples("shapes", none);
  EXPECT_EQ(examples.seen, "shapes[round radius_mm square ?width_mm ]");
  EXPECT_TRUE(none.empty());
}

TEST(NamesOf, GoBothWays) {
  EXPECT_EQ(to_string(Shape::Square), "square");
  EXPECT_EQ(to_string(static_cast<Shape>(2)), "unknown");
  EXPECT_EQ(value_of<Shape>("round"), Shape::Round);
  EXPECT_EQ(value_of<Shape>("oval"), std::nullopt);
  EXPECT_EQ(values_of<Shape>(), (std::array{Shape::Round, Shape::Square}));
}

TEST(Choices, AreListedAsInASentence) {
  EXPECT_EQ(choices(names_of(Shape{})), "round or square");
  EXPECT_EQ(choices(std::array<std::string_view, 3>{"a", "b", "c"}), "a, b or c");
  EXPECT_EQ(choices(std::array<std::string_view, 1>{"a"}), "a");
}

TEST(RangeText, SaysTheLimits) {
  EXPECT_EQ(describe(kPositive), "a number above 0");
  EXPECT_EQ(describe(Range{0.0, 0.5, false, true}), "a number in [0, 0.5)");
  EXPECT_TRUE(contains(Range{0.0, 1.0}, 1.0));
  EXPECT_FALSE(contains(kAny, std::nan("")));
}

}  // namespace
}  // namespace incise
