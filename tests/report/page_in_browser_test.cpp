#include "report/markup.hpp"
#include "report/ring_fixture.hpp"
#include "support/temporary_folder.hpp"

#include <incise/io/atomic_file.hpp>
#include <incise/report/html_report.hpp>

#include <gmock/gmock.h>

#include <cstdlib>
#include <optional>

namespace incise {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::texts_between;

/// A Chromium or Chrome on the PATH.
std::optional<std::string> browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    if (std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0) return name;
  }
  return std::nullopt;
}

#define INCISE_NEEDS_BROWSER() \
  if (!browser())              \
  GTEST_SKIP() << "NOT TESTED: the report was not opened, because there is no chromium or google-chrome on the PATH"

/// Opens a page without a display and a network; returns its document after the scripts have run.
std::string opened(const testing::TemporaryFolder& folder, const std::filesystem::path& page, const std::string& more) {
  const std::filesystem::path document = folder / "document.html";
  const std::string command =
      "timeout -k 5 3600 " + *browser() +
      " --headless --no-sandbox --disable-dev-shm-usage --disable-quic --no-first-run --disable-background-networking "
      "--disable-component-update --disable-sync --proxy-server=127.0.0.1:9 --hide-scrollbars "
      "--virtual-time-budget=5000 " +
      more + " --user-data-dir=" + (folder / "profile").string() + " file://" + page.string() + " >" +
      document.string() + " 2>" + (folder / "messages.txt").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << read_text(folder / "messages.txt");
  return read_text(document);
}

/// Where pictures of the page are kept for a person to look at, if INCISE_SCREENSHOT_DIR says so.
std::filesystem::path picture_path(const testing::TemporaryFolder& folder, const std::string& name) {
  const char* kept = std::getenv("INCISE_SCREENSHOT_DIR");
  return kept == nullptr ? folder / name : std::filesystem::path(kept) / name;
}

TEST(PageInBrowser, DrawsTheMeshAndTheCutWithWebGl) {
  INCISE_NEEDS_BROWSER();
  const testing::TemporaryFolder folder;
  const std::filesystem::path page = picture_path(folder, "report.html");
  write_report(testing::RingFixture(1.65).data(12), page);
  const std::string document = opened(folder, page, "--enable-unsafe-swiftshader --window-size=1400,1000 --dump-dom");
  EXPECT_THAT(document, HasSubstr("data-page-ready=\"yes\""));
  EXPECT_THAT(document, Not(HasSubstr("data-script-error=")));
  EXPECT_THAT(document, Not(HasSubstr("data-viewer-failed=")));
  EXPECT_EQ(texts_between(document, "data-viewer-ready=\"", "\"").size(), 2U);
  EXPECT_THAT(document, HasSubstr("frames=14 time_s=11"));
  const auto coverages = texts_between(document, "data-coverage=\"", "\"");
  ASSERT_EQ(coverages.size(), 2U);
  for (const std::string& coverage : coverages) {  // share of the view that is not background
    EXPECT_GT(std::stod(coverage), 0.1);
    EXPECT_LT(std::stod(coverage), 0.9);
  }
}

TEST(PageInBrowser, MakesAPicture) {
  INCISE_NEEDS_BROWSER();
  const testing::TemporaryFolder folder;
  const std::filesystem::path page = folder / "report.html";
  write_report(testing::RingFixture(1.65).data(12), page);
  const std::filesystem::path picture = picture_path(folder, "report.png");
  static_cast<void>(
      opened(folder, page, "--enable-unsafe-swiftshader --window-size=1400,6400 --screenshot=" + picture.string()));
  EXPECT_GT(std::filesystem::file_size(picture), 50'000U);
}

TEST(PageInBrowser, KeepsStillPicturesAndSaysSoWithoutWebGl) {
  INCISE_NEEDS_BROWSER();
  const testing::TemporaryFolder folder;
  const std::filesystem::path page = folder / "report.html";
  write_report(testing::RingFixture(4.0).data(3), page);
  const std::string document =
      opened(folder, page, "--disable-gpu --disable-3d-apis --window-size=1400,1000 --dump-dom");
  EXPECT_THAT(document, HasSubstr("data-page-ready=\"yes\""));
  EXPECT_EQ(texts_between(document, "data-viewer-failed=\"", "\"").size(), 2U);
  EXPECT_THAT(document, HasSubstr("The 3D view needs WebGL"));
  EXPECT_THAT(document, Not(HasSubstr("class=\"stage live\"")));
}

}  // namespace
}  // namespace incise
