#include "procedure/ring_in_a_block.hpp"
#include "procedure/same_incision.hpp"
#include "support/temporary_folder.hpp"

#include <incise/core/error.hpp>
#include <incise/io/atomic_file.hpp>
#include <incise/io/manifest.hpp>
#include <incise/storage/checkpoint_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <limits>

namespace incise {
namespace {

const std::string kKey(64, 'a');
constexpr std::size_t kHashDigits = 64;

/// A cut that was interrupted half-way, in a file.
class CheckpointFileTest : public testing::RingInABlock {
 protected:
  CheckpointFileTest() : RingInABlock(16) {
    settings_.cut.dullness = 4.0;
    settings_.frames = 4;
    Workers workers(1);
    static_cast<void>(continue_incision(model_, rest_state(model_), path_, settings_,
                                        begin_incision(model_, rest_state(model_), path_, settings_), workers, half_,
                                        [this](const IncisionProgress& progress, bool) { progress_ = progress; }));
    write_checkpoint(file_, kKey, "a test", progress_);
    bytes_ = read_text(file_);
  }

  [[nodiscard]] IncisionProgress read() const { return CheckpointFile(file_).progress(model_); }

  /// The progress as it is now, in the file.
  void rewrite() const { write_checkpoint(file_, kKey, "a test", progress_); }

  void replace_file(const std::string& bytes) const { std::ofstream(file_, std::ios::binary | std::ios::trunc) << bytes; }

  /// The file with some bytes changed and a SHA-256 that fits them.
  void forge(std::size_t at, const std::string& with) const {
    std::string bytes = bytes_.substr(0, bytes_.size() - kHashDigits);
    bytes.replace(at, with.size(), with);
    replace_file(bytes + sha256_of_text(bytes));
  }

  /// Expects reading to be refused with a message that names the file and a byte, and holds `says`.
  void expect_refused(const std::string& says, const std::string& which = "") const {
    SCOPED_TRACE(which);
    try {
      static_cast<void>(read());
      FAIL() << "expected DataError";
    } catch (const DataError& error) {
      EXPECT_EQ(error.path(), file_);
      EXPECT_NE(std::string(error.what()).find("byte "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("Remove the file"), std::string::npos) << error.what();
    }
  }

  /// Where the count of the positions stands: behind magic, version, length, key and maker.
  [[nodiscard]] static std::size_t positions_at() { return 8 + 4 + 8 + (8 + kKey.size()) + (8 + 6); }

  static std::string number(std::uint64_t value) {
    std::string bytes;
    for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(value >> (8 * i) & 0xFFU));
    return bytes;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "as_planned.checkpoint";
  ToolPath path_ = ring(4.0);
  StopAtHalf half_;
  IncisionProgress progress_;
  std::string bytes_;
};

TEST_F(CheckpointFileTest, KeepsEveryCauseOfRemoval) {
  ASSERT_GE(progress_.state.record.removals.size(), kRemovalCauses.size());
  for (std::size_t i = 0; i < kRemovalCauses.size(); ++i) progress_.state.record.removals[i].cause = kRemovalCauses[i];
  write_checkpoint(file_, std::string(kKey), "maker", progress_);
  const IncisionProgress back = read();
  for (std::size_t i = 0; i < kRemovalCauses.size(); ++i) EXPECT_EQ(back.state.record.removals[i].cause, kRemovalCauses[i]);
}

TEST_F(CheckpointFileTest, AnIncisionGoesOnFromItWithTheBitsOfAnUninterruptedOne) {
  ASSERT_FALSE(progress_.state.record.removals.empty());
  ASSERT_FALSE(progress_.state.bonds.empty());
  ASSERT_GT(progress_.frames.size(), 1U);
  Workers workers(1);
  Monitor silent;
  const IncisionResult resumed = continue_incision(model_, rest_state(model_), path_, settings_, read(), workers, silent);
  testing::expect_same(cut(path_), resumed, "from a file");
  EXPECT_EQ(resumed.outcome, Outcome::Success);
}

TEST_F(CheckpointFileTest, SaysWhatItIsOfAndByWhomItWasMade) {
  const CheckpointFile file(file_);
  EXPECT_EQ(file.key(), kKey);
  EXPECT_EQ(file.maker(), "a test");
}

TEST_F(CheckpointFileTest, ReadAndWrittenAgainIsTheSameFile) {
  write_checkpoint(folder_ / "again", kKey, "a test", read());
  EXPECT_EQ(read_text(folder_ / "again"), bytes_);
}

TEST_F(CheckpointFileTest, KeepsWhatViscousTissueRemembers) {
  model_.material.prony = {{0.5, 1.0}, {0.25, 0.1}};
  const std::size_t tets = model_.mesh.tets.size();
  progress_.state.tissue.memory.strains.assign(tets, Mat3::Identity() * 0.25);
  progress_.state.tissue.memory.branches.assign(2 * tets, Mat3::Constant(-1.5));
  write_checkpoint(file_, kKey, "a test", progress_);
  EXPECT_EQ(read().state.tissue.memory, progress_.state.tissue.memory);
}

TEST_F(CheckpointFileTest, AMemoryThatTheTissueDoesNotHaveIsRefused) {
  const std::size_t tets = model_.mesh.tets.size();
  progress_.state.tissue.memory.strains.assign(3, Mat3::Zero());
  rewrite();
  expect_refused("strains: found 3, expected 0, as the tissue has", "tissue that is not viscous");
  model_.material.prony = {{0.5, 1.0}};
  expect_refused(fmt::format("strains: found 3, expected {}", tets));
  progress_.state.tissue.memory.strains.assign(tets, Mat3::Zero());
  progress_.state.tissue.memory.branches.assign(2 * tets, Mat3::Zero());
  rewrite();
  expect_refused(fmt::format("branches: found {}, expected {}", 2 * tets, tets), "branches of another material");
}

TEST_F(CheckpointFileTest, BondsOutOfOrderOrTwiceAreRefused) {
  std::vector<Bond>& bonds = progress_.state.bonds;
  ASSERT_GT(bonds.size(), 1U);
  const std::vector<Bond> whole = bonds;
  std::swap(bonds[0], bonds[1]);
  rewrite();
  expect_refused(fmt::format("bonds: found tet {} behind tet {}, expected each tet once, ascending", whole[0].tet.value, whole[1].tet.value));
  bonds = whole;
  bonds.insert(bonds.begin(), bonds.front());
  rewrite();
  expect_refused(fmt::format("bonds: found tet {} behind tet {}", whole[0].tet.value, whole[0].tet.value));
}

TEST_F(CheckpointFileTest, FieldsThatContradictEachOtherAreRefused) {
  const IncisionProgress whole = progress_;
  const auto expect_contradiction = [&](const char* says) {
    rewrite();
    try {
      static_cast<void>(read());
      ADD_FAILURE() << "expected DataError: " << says;
    } catch (const DataError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
    progress_ = whole;
  };
  const TetId removed = whole.state.record.removals.front().tet;
  progress_.state.bonds.insert(std::lower_bound(progress_.state.bonds.begin(), progress_.state.bonds.end(), removed,
                                                [](const Bond& bond, TetId tet) { return bond.tet < tet; }),
                               Bond{removed, Vec3::Zero()});
  expect_contradiction("bonds: found tet");
  progress_.state.record.removals.push_back(progress_.state.record.removals.front());
  expect_contradiction("removals: found tet");
  progress_.state.record.removals.pop_back();
  expect_contradiction("is_live: found other tets");
  progress_.steps.pop_back();
  expect_contradiction("step: found");
}

TEST_F(CheckpointFileTest, CutShortAnywhereIsRefused) {
  for (const double share : {0.0, 1e-6, 1e-5, 1e-4, 0.1, 0.5, 0.9, 0.999999}) {
    replace_file(bytes_.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes_.size()))));
    expect_refused("", fmt::format("{} of it", share));
  }
  replace_file(bytes_.substr(0, bytes_.size() / 2));
  expect_refused(fmt::format("byte {}: found the end of the file, expected {} bytes", bytes_.size() / 2, bytes_.size()));
}

TEST_F(CheckpointFileTest, AFlippedBitAnywhereIsRefused) {
  for (std::size_t at = 0; at < bytes_.size(); at += bytes_.size() / 13) {
    std::string bytes = bytes_;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    replace_file(bytes);
    expect_refused("", fmt::format("byte {}", at));
  }
  std::string bytes = bytes_;
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x10);
  replace_file(bytes);
  expect_refused("the file is damaged");
}

TEST_F(CheckpointFileTest, AForeignFileIsRefused) {
  replace_file("This is a letter, not a checkpoint.\n");
  expect_refused("expected a checkpoint of incise");
}

TEST_F(CheckpointFileTest, OfAnotherVersionIsRefused) {
  forge(8, std::string("\x07\0\0\0", 4));
  expect_refused("version: found 7, expected 1");
}

TEST_F(CheckpointFileTest, ACountThatTheMeshDoesNotHaveIsRefusedBeforeAnythingIsMadeForIt) {
  forge(positions_at(), number(std::uint64_t{1} << 60));
  expect_refused(fmt::format("byte {}: positions: found 1152921504606846976, expected {}", positions_at(), model_.mesh.vertices.size()));
}

TEST_F(CheckpointFileTest, ANumberThatIsNotFiniteIsRefused) {
  const auto nan = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::quiet_NaN());
  forge(positions_at() + 8, number(nan));
  expect_refused(fmt::format("byte {}: position: found nan, expected a finite number", positions_at() + 8));
}

TEST_F(CheckpointFileTest, ATextLongerThanTheFileIsRefused) {
  forge(20, number(std::uint64_t{1} << 40));
  expect_refused("byte 20: key: found 1099511627776");
}

TEST_F(CheckpointFileTest, OfAnotherMeshIsRefused) {
  const TissueModel other = make_tissue_model(make_block({32, 32, 8}, {12, 12, 3}), Material{},
                                              {FixedConstraint{BoxRegion{Box3(Vec3(-1, -1, -1), Vec3(33, 33, 0.1))}}});
  EXPECT_THROW(static_cast<void>(CheckpointFile(file_).progress(other)), DataError);
}

}  // namespace
}  // namespace incise
