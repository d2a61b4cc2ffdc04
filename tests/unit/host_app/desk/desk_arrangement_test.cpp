#include "host_app/desk/desk_arrangement.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class DeskFile : public testing::Test {
  protected:
    void write(const std::string& text) const { std::ofstream(file_) << text; }
    void expect_refused(const std::string& text, const std::string& word) const {
        write("version = 1\n" + text);
        EXPECT_NE(thrown_sentence([&] { (void)load_desk(file_); }).find(word), std::string::npos)
            << text;
    }
    static DeskArrangement example() {
        DeskArrangement desk;
        desk.switches.panels = false;
        desk.switches.rigs = false;
        desk.switches.outside = true;
        desk.switches.eye = {-1, 0.8, 0.25};
        desk.switches.rigs_apart = true;
        desk.switches.figures = true;
        desk.window = WindowPlace{-1920, 40, 1600, 900, true};
        desk.rigs_window = WindowPlace{0, 0, 1920, 1080, false};
        return desk;
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "stage.desk.toml";
};

TEST_F(DeskFile, DocumentedExampleLoads) {
    const DeskArrangement desk = load_desk(source_folder() / "hw_config/desk.toml");
    ASSERT_TRUE(desk.window && desk.rigs_window);
    EXPECT_EQ(desk.window->width, 1280);
    EXPECT_EQ(desk.rigs_window->x, 1920);
}

TEST_F(DeskFile, IsReadAsWritten) {
    write(to_toml(example()));
    DeskArrangement read = load_desk(file_);
    EXPECT_NEAR(read.switches.eye.azimuth_rad, -1, 0.001);
    EXPECT_NEAR(read.switches.eye.elevation_rad, 0.8, 0.001);
    read.switches.eye = example().switches.eye;
    EXPECT_EQ(read, example());
    write("version = 1\n");
    EXPECT_EQ(load_desk(file_), DeskArrangement()) << "missing keys have their defaults";
}

TEST_F(DeskFile, RefusesInvalidValues) {
    expect_refused("panels = 3\n", "panels");
    expect_refused("multiview = true\n", "multiview");
    expect_refused("[eye]\nelevation_deg = 100\n", "elevation_deg");
    expect_refused("[window]\nx = 1\n", "is missing");
    expect_refused("[window]\nx = 1\ny = 1\nwidth = 100\nheight = 500\n", "width");
}

TEST_F(DeskFile, IsWrittenOnlyAfterTheOperatorArrangedTheDesk) {
    EXPECT_EQ(desk_file_of("a/stage.toml"), "a/stage.desk.toml");
    DeskStore store(file_);
    DeskArrangement desk = store.desk();
    desk.window = WindowPlace{10, 10, 1280, 720};
    store.follow(desk, MonotonicClock::now());
    store.finish();
    EXPECT_FALSE(std::filesystem::exists(file_)) << "the window manager chose the place";
    desk.switches.rigs = false;
    store.follow(desk, MonotonicClock::now());
    EXPECT_FALSE(std::filesystem::exists(file_)) << "not yet";
    store.follow(desk, MonotonicClock::now() + 1h);
    EXPECT_EQ(load_desk(file_).window, desk.window);
    EXPECT_FALSE(load_desk(file_).switches.rigs);
    write("# of another program\n");
    desk.window->x = 50;
    store.follow(desk, MonotonicClock::now());
    store.finish();
    EXPECT_EQ(load_desk(file_).window->x, 50);
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "stage.desk-2.toml"))
        << "another program's file is kept";
}

}  // namespace
}  // namespace vantage
