#include "host_app/flight/moves/flight_store.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "host_app/flight/moves/move.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class FlightStoreTest : public testing::Test {
  protected:
    static OrbitView looking(double azimuth_rad) {
        OrbitView view;
        view.azimuth_rad = azimuth_rad;
        return view;
    }
    static FlightController::Change shot(double azimuth_rad) {
        FlightController::Change change;
        change.book.shots[0] = Shot{"wide", looking(azimuth_rad)};
        return change;
    }
    static FlightController::Change move(double azimuth_rad) {
        FlightController::Change change;
        change.book.move = appended({}, looking(azimuth_rad), {}, 1, {});
        change.is_of_move = true;
        return change;
    }
    static FlightRecording recording() {
        FlightRecording flight;
        for (int i = 0; i < 50; ++i) flight.push_back({0.02 * i, looking(0.01 * i), {}});
        return flight;
    }
    std::string text(const std::string& name = "stage.flight.toml") const {
        std::ostringstream text;
        text << std::ifstream(folder_.path() / name).rdbuf();
        return text.str();
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(folder_.path()), {}));
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_.path() / "stage.flight.toml";
    MonotonicTime now_{1h};
};

TEST(FlightStoreFile, IsBesideTheStageOrTheTake) {
    EXPECT_EQ(flight_file_of("a/stage.toml"), "a/stage.flight.toml");
    EXPECT_EQ(flight_file_of("take-2.mkv"), "take-2.flight.toml");
}

TEST_F(FlightStoreTest, WritesNothingWithoutAChange) {
    FlightStore store(file_);
    EXPECT_FALSE(store.follow(MonotonicClock::now() + 1h));
    store.finish();
    EXPECT_EQ(files(), 0u);
}

TEST_F(FlightStoreTest, KeepsStoredShotsForTheNextSession) {
    {
        FlightStore store(file_);
        store.keep(shot(0.5));
        EXPECT_EQ(files(), 0u) << "several changes are written at once";
        (void)store.follow(MonotonicClock::now() + 2s);
        EXPECT_EQ(files(), 1u);
        store.keep(shot(0.7));
        store.finish();
    }
    EXPECT_EQ(files(), 1u) << "its own file is replaced";
    EXPECT_NEAR(FlightStore(file_).book().shots[0]->view.azimuth_rad, 0.7, 1e-7);
}

TEST_F(FlightStoreTest, KeepsAFileThatAnotherProgramChanged) {
    FlightStore store(file_);
    std::ofstream(file_) << "# by hand\nversion = 1\n";
    store.keep(shot(0.5));
    store.finish();
    EXPECT_EQ(text("stage.flight-2.toml"), "# by hand\nversion = 1\n");
    EXPECT_NE(text().find("wide"), std::string::npos);
}

TEST_F(FlightStoreTest, KeepsTheOldFileWhenARecordedFlightReplacesTheMove) {
    {
        FlightStore first(file_);
        first.keep(move(0.25));
        first.finish();
    }
    const std::string before = text();
    FlightStore store(file_);
    store.simplify(recording(), {});
    std::optional<Move> made;
    while (!made) made = store.follow(MonotonicClock::now());
    EXPECT_NEAR(made->duration_s(), 0.98, 1e-9);
    store.finish();
    EXPECT_EQ(text("stage.flight-2.toml"), before);
    EXPECT_EQ(FlightStore(file_).book().move->keyframes().size(), made->keyframes().size());
    store.keep(move(0.5));
    store.finish();
    EXPECT_EQ(files(), 2u) << "an edited move is still the file's move";
}

TEST_F(FlightStoreTest, KeepsTheOldFileWhenAnotherMoveIsEdited) {
    {
        FlightStore first(file_);
        first.keep(move(0.25));
        first.finish();
    }
    FlightStore store(file_);
    store.begin_with_another_move();
    store.keep(shot(0.1));
    store.finish();
    EXPECT_EQ(files(), 1u);
    EXPECT_NEAR(FlightStore(file_).book().move->at(0).azimuth_rad, 0.25, 1e-7);
    store.keep(move(0.75));
    store.finish();
    EXPECT_EQ(files(), 2u);
    EXPECT_NEAR(FlightStore(file_).book().move->at(0).azimuth_rad, 0.75, 1e-7);
    EXPECT_NEAR(FlightStore(folder_.path() / "stage.flight-2.toml").book().move->at(0).azimuth_rad,
                0.25, 1e-7);
}

TEST_F(FlightStoreTest, WaitsForFlightsThatAreBeingSimplified) {
    FlightStore store(file_);
    store.simplify(recording(), {});
    store.finish();
    EXPECT_TRUE(FlightStore(file_).book().move);
}

TEST_F(FlightStoreTest, ContinuesIfTheFolderIsNotWritable) {
    FlightStore store(folder_.path() / "none" / "stage.flight.toml");
    store.keep(shot(0.5));
    (void)store.follow(MonotonicClock::now() + 2s);
    std::filesystem::create_directory(folder_.path() / "none");
    store.finish();
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "none" / "stage.flight.toml"));
}

TEST_F(FlightStoreTest, RejectsAnInvalidFile) {
    std::ofstream(file_) << "version = 1\nshots = 3\n";
    EXPECT_NE(thrown_sentence([&] { FlightStore store(file_); }).find("stage.flight.toml:2"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
