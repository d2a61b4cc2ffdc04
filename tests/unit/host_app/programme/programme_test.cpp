#include "host_app/programme/programme.h"

#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/gl/context/context_group.h"
#include "common/gl/context/driver_lock.h"
#include "host_app/programme/reprojection.h"
#include "tests/support/eventually.h"
#include "tests/support/gpu_reset.h"
#include "tests/unit/host_app/frames/scripted_feed.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// A camera source that a test scripts, and that counts its steps.
class ScriptedCameraSource final : public CameraSource {
  public:
    ScriptedCameraSource() {
        // The place of the rigs, from where the whole wall is visible.
        next_.view.distance_m = 4.5;
        next_.view.field_of_view_rad = 1.0;
    }

    CameraStep step(double /*time_s*/, std::optional<double> /*past_pulse*/) override {
        const std::lock_guard lock(mutex_);
        if (!failure_.empty()) throw Error(failure_);
        ++steps_;
        // The turn reverses, so that the wall stays in the middle however long a test takes.
        if (std::abs(next_.view.azimuth_rad + turn_rad_) > furthest_rad_) turn_rad_ = -turn_rad_;
        next_.view.azimuth_rad += turn_rad_;
        if (next_.preview) next_.preview->azimuth_rad += preview_turn_rad_;
        CameraStep step = next_;
        next_ = {.view = step.view, .preview = step.preview};
        return step;
    }

    CameraStep fly_to_shot(int number) override {
        const std::lock_guard lock(mutex_);
        shot_ = number;
        return {.view = next_.view};
    }

    /// Changes the next step; only its view lasts longer.
    template <class Change>
    void next(Change change) {
        const std::lock_guard lock(mutex_);
        change(next_);
    }
    /// Turns the camera at every step, back and forth.
    void turn(double rad, double furthest_rad = 0.1) {
        const std::lock_guard lock(mutex_);
        turn_rad_ = rad;
        furthest_rad_ = furthest_rad;
    }
    void turn_preview(double rad) {
        const std::lock_guard lock(mutex_);
        preview_turn_rad_ = rad;
    }
    void fail_with(std::string sentence) {
        const std::lock_guard lock(mutex_);
        failure_ = std::move(sentence);
    }
    int steps() const {
        const std::lock_guard lock(mutex_);
        return steps_;
    }
    /// The last shot that was requested; 0: none.
    int shot() const {
        const std::lock_guard lock(mutex_);
        return shot_;
    }

  private:
    mutable std::mutex mutex_;
    CameraStep next_;
    double turn_rad_ = 0, furthest_rad_ = 0, preview_turn_rad_ = 0;
    int steps_ = 0, shot_ = 0;
    std::string failure_;
};

/// Frames that a sink was given.
struct Seen {
    std::mutex mutex;
    std::vector<std::uint64_t> ticks;
    std::vector<CameraState> cameras;
    int empty_pictures = 0;
    cv::Vec4b last_middle;
    std::uint64_t last_pulse = 0;
    bool is_finished = false;

    std::size_t count() {
        const std::lock_guard lock(mutex);
        return ticks.size();
    }
};

class NotingSink final : public PictureSink {
  public:
    explicit NotingSink(std::shared_ptr<Seen> seen) : seen_(std::move(seen)) {}
    std::string name() const override { return "notes"; }
    void take(const ProgrammePicture& picture) override {
        const std::lock_guard lock(seen_->mutex);
        seen_->ticks.push_back(picture.tick);
        seen_->cameras.push_back(picture.camera);
        seen_->empty_pictures += picture.picture.empty() || picture.overlaid.empty();
        seen_->last_middle = picture.picture(picture.picture.rows / 2, picture.picture.cols / 2);
        seen_->last_pulse = picture.set->trigger_index;
    }
    void finish() override { seen_->is_finished = true; }

  private:
    std::shared_ptr<Seen> seen_;
};

/// Fails after some frames, or at its end.
class FailingSink final : public PictureSink {
  public:
    FailingSink(int pictures, std::shared_ptr<Seen> seen)
        : left_(pictures), seen_(std::move(seen)) {}
    std::string name() const override { return "broken line"; }
    void take(const ProgrammePicture& picture) override {
        if (left_-- == 0) fail("the line is broken");
        const std::lock_guard lock(seen_->mutex);
        seen_->ticks.push_back(picture.tick);
    }
    void finish() override { fail("the line did not end well"); }

  private:
    int left_;
    std::shared_ptr<Seen> seen_;
};

/// Delays the programme once.
class SlowSink final : public PictureSink {
  public:
    explicit SlowSink(std::chrono::milliseconds time) : time_(time) {}
    std::string name() const override { return "slow line"; }
    void take(const ProgrammePicture& picture) override {
        if (picture.tick == 3) std::this_thread::sleep_for(time_);
    }

  private:
    std::chrono::milliseconds time_;
};

/// A preparer that takes as long as a test sets, and whose instants have the requested level.
class SlowPreparer final : public InstantPreparer {
  public:
    SlowPreparer(std::unique_ptr<InstantPreparer> preparer,
                 std::shared_ptr<std::atomic<int>> sleep_ms)
        : preparer_(std::move(preparer)), sleep_ms_(std::move(sleep_ms)) {}

    void take(std::span<const DepthView> views, double dt_s) override {
        sleep();
        preparer_->take(views, dt_s);
    }
    std::shared_ptr<const Instant> prepare(const VirtualView& target,
                                           const PrepareLevel& level) override {
        auto instant = std::make_shared<Instant>(*preparer_->prepare(target, level));
        instant->level = level.rank;
        return instant;
    }

  private:
    /// Waits as a preparer waits for its GPU.
    void sleep() const {
        const DriverLock::Pause pause;
        constexpr int step_ms = 5;
        // In short steps, so that a test can end it.
        for (int slept_ms = 0; slept_ms < *sleep_ms_; slept_ms += step_ms)
            std::this_thread::sleep_for(std::chrono::milliseconds(step_ms));
    }

    std::unique_ptr<InstantPreparer> preparer_;
    std::shared_ptr<std::atomic<int>> sleep_ms_;
};

class ProgrammeTest : public testing::Test {
  protected:
    static constexpr double rate_hz = 25;
    /// A turn per tick that is large enough for a new frame.
    static constexpr double rendered_turn_rad = 0.03;

    ProgrammeTest() { instants_settings_.pulse_rate_hz = rate_hz; }

    /// A programme that is ready to start, with a sink that notes its frames.
    Programme& make() {
        instants_.emplace(instants_settings_, feed_.feed(), contexts_);
        return make_programme();
    }
    /// The same with a preparer that sleeps for `sleep_ms_`.
    Programme& make_with_slow_preparer() {
        instants_.emplace(instants_settings_, feed_.feed(), contexts_);
        const auto entry = find_synthesiser(settings_.synthesiser);
        const auto is_made = std::make_shared<std::atomic<bool>>(false);
        // The preparer of a synthesiser is created once.
        instants_->prepare_for(
            entry.name, [entry, is_made, sleep = sleep_ms_](const ShaderLibrary& shaders) {
                *is_made = true;
                return std::make_unique<SlowPreparer>(entry.make_preparer(shaders), sleep);
            });
        EXPECT_TRUE(eventually([&] { return is_made->load(); }));
        return make_programme();
    }
    Programme& make_programme() {
        programme_.emplace(settings_, *instants_, camera_source_);
        programme_->add(std::make_unique<NotingSink>(seen_));
        return *programme_;
    }
    void start() {
        programme_->start([](std::uint64_t, double) { return false; });
    }
    /// Frames that take longer than a tick.
    void ask_for_long_pictures() {
        settings_.format = {.width_px = 480, .height_px = 270};
        settings_.rate_hz = 200;
        settings_.quality.level = 0;
    }
    void push(std::uint64_t pulse, unsigned char red = 200) {
        feed_.push(feed_.set(pulse, {"north", "south"}, {red, 100, 50, 255}));
    }
    std::uint64_t shown_pulse() const {
        const std::shared_ptr<const MadePicture> picture = programme_->state().picture;
        return picture ? picture->job.instant->set->trigger_index : 0;
    }
    bool wait_for_pulse(std::uint64_t pulse) {
        return eventually([&] { return shown_pulse() == pulse; });
    }
    /// Waits for so many ticks.
    bool wait_for_ticks(std::size_t ticks) {
        const std::size_t before = seen_->count();
        return eventually([&] { return seen_->count() >= before + ticks; });
    }
    void expect_every_tick_once() {
        const std::lock_guard lock(seen_->mutex);
        for (std::size_t i = 0; i < seen_->ticks.size(); ++i) ASSERT_EQ(seen_->ticks[i], i);
        EXPECT_EQ(seen_->empty_pictures, 0);
    }

    ContextGroup contexts_;
    ScriptedFeed feed_{{"north", "south"}};
    ScriptedCameraSource camera_source_;
    std::shared_ptr<Seen> seen_ = std::make_shared<Seen>();
    std::shared_ptr<std::atomic<int>> sleep_ms_ = std::make_shared<std::atomic<int>>(0);
    InstantThread::Settings instants_settings_;
    Programme::Settings settings_{.format = {.width_px = 64, .height_px = 48},
                                  .rate_hz = rate_hz,
                                  .pulse_rate_hz = rate_hz,
                                  .synthesiser = "mesh",
                                  .quality = {}};
    std::optional<InstantThread> instants_;
    std::optional<Programme> programme_;
};

TEST_F(ProgrammeTest, ShowsTheNewestInstant) {
    make();
    start();
    push(1, 200);
    ASSERT_TRUE(wait_for_pulse(1));
    push(2, 20);
    ASSERT_TRUE(wait_for_pulse(2));
    ASSERT_TRUE(wait_for_ticks(2));
    const std::lock_guard lock(seen_->mutex);
    EXPECT_EQ(seen_->last_pulse, 2u);
    EXPECT_NEAR(seen_->last_middle[0], 20, 2);
}

TEST_F(ProgrammeTest, GivesNothingBeforeTheFirstFrame) {
    make();
    start();
    ASSERT_TRUE(eventually([&] { return camera_source_.steps() > 10; }))
        << "the camera source is still asked";
    EXPECT_EQ(seen_->count(), 0u);
    EXPECT_EQ(programme_->stats().ticks, 0u);
    push(1);
    ASSERT_TRUE(wait_for_ticks(3));
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, TicksContinueWithoutANewInstant) {
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    ASSERT_TRUE(wait_for_ticks(20));
    programme_->stop();
    expect_every_tick_once();
    const ProgrammeStats stats = programme_->stats();
    EXPECT_EQ(stats.ticks, seen_->count());
    EXPECT_GE(stats.pictures, 1u);
    EXPECT_LE(stats.pictures, 3u) << "nothing changed, so the same picture is handed out again";
    EXPECT_TRUE(seen_->is_finished);
}

TEST_F(ProgrammeTest, CameraFliesOnWithoutANewInstant) {
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    const std::uint64_t before = programme_->stats().pictures;
    camera_source_.turn(0.01);
    ASSERT_TRUE(eventually([&] { return programme_->stats().pictures > before + 10; }));
    EXPECT_EQ(shown_pulse(), 1u);
}

TEST_F(ProgrammeTest, SlowPreparerDelaysNoTick) {
    make_with_slow_preparer();
    camera_source_.turn(0.002);
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    *sleep_ms_ = 3'600'000;
    const std::size_t ticks_before = seen_->count();
    const int steps_before = camera_source_.steps();
    const std::uint64_t pictures_before = programme_->stats().pictures;
    const std::uint64_t prepared_before = instants_->stats().prepared;
    std::uint64_t pulse = 1;
    EXPECT_TRUE(eventually([&] {
        push(++pulse);
        return seen_->count() >= ticks_before + 50 && camera_source_.steps() >= steps_before + 30 &&
               programme_->stats().pictures >= pictures_before + 20;
    }));
    EXPECT_LE(instants_->stats().prepared, prepared_before + 1) << "it does sleep";
    *sleep_ms_ = 0;
    programme_->stop();
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, LongFramesLeaveTimeToInstants) {
    ask_for_long_pictures();
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn(rendered_turn_rad);
    const std::uint64_t before = programme_->stats().pictures;
    const auto begin = MonotonicClock::now();
    ASSERT_TRUE(eventually([&] { return programme_->stats().pictures >= before + 60; }));
    const double passed_ms = ms_since(begin);
    const ProgrammeStats stats = programme_->stats();
    EXPECT_GT(stats.render_ms.p50, 1000 / settings_.rate_hz) << "longer than a tick";
    const double rendered_ms = static_cast<double>(stats.pictures - before) * stats.render_ms.p50;
    EXPECT_LT(rendered_ms, 0.75 * passed_ms + 200) << "of " << passed_ms << " ms";
}

TEST_F(ProgrammeTest, RendersNoPreviewUnlessThereIsOne) {
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn(0.01);
    ASSERT_TRUE(wait_for_ticks(20));
    EXPECT_FALSE(programme_->state().preview.view);
    EXPECT_EQ(programme_->stats().preview_pictures, 0u);
}

TEST_F(ProgrammeTest, PreviewIsRenderedWhileTheProgrammeTicks) {
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    const CameraState stands = programme_->state().picture->job.camera;
    camera_source_.turn_preview(0.002);
    camera_source_.next([](CameraStep& step) { step.preview = step.view; });
    ASSERT_TRUE(eventually([&] { return programme_->stats().preview_pictures >= 10; }));
    const ProgrammeState state = programme_->state();
    ASSERT_TRUE(state.preview.picture);
    EXPECT_EQ(state.preview.picture->picture.size(), cv::Size(32, 24)) << "half of 64x48";
    EXPECT_FALSE(is_same_view(state.preview.picture->job.camera, stands));
    EXPECT_EQ(state.preview.picture->job.instant->set->trigger_index, 1u)
        << "of the instant that is there";
    EXPECT_TRUE(is_same_view(state.picture->job.camera, stands));
    camera_source_.next([](CameraStep& step) { step.preview.reset(); });
    ASSERT_TRUE(eventually([&] { return !programme_->state().preview.picture; }));
    programme_->stop();
    expect_every_tick_once();
    EXPECT_EQ(programme_->stats().ticks, seen_->count());
    EXPECT_GT(programme_->stats().preview_ms.count, 0u);
}

TEST_F(ProgrammeTest, PreviewCostsTheProgrammeNoFrame) {
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn(rendered_turn_rad);
    camera_source_.turn_preview(0.003);
    camera_source_.next([](CameraStep& step) { step.preview = step.view; });
    ASSERT_TRUE(eventually([&] { return programme_->stats().preview_pictures >= 10; }));
    programme_->stop();
    const ProgrammeStats stats = programme_->stats();
    EXPECT_EQ(stats.ticks, seen_->count());
    EXPECT_GE(stats.pictures, stats.preview_pictures) << "the programme goes first";
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, PreviewContinuesAfterAGpuResetAndWithAnotherSynthesiser) {
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn_preview(0.002);
    camera_source_.next([](CameraStep& step) { step.preview = step.view; });
    const auto more_come = [&] {
        const std::uint64_t before = programme_->stats().preview_pictures;
        return eventually([&] { return programme_->stats().preview_pictures > before + 3; });
    };
    ASSERT_TRUE(more_come());
    reset_gpu();
    ASSERT_TRUE(eventually([&] { return instants_->newest()->generation == 2; }));
    EXPECT_TRUE(more_come());
    camera_source_.next([](CameraStep& step) { step.next_synthesiser = true; });
    ASSERT_TRUE(eventually([&] { return programme_->state().synthesiser != "mesh"; }));
    EXPECT_TRUE(eventually([&] {
        const auto picture = programme_->state().preview.picture;
        return picture && picture->job.instant->synthesiser == programme_->state().synthesiser;
    }));
}

TEST_F(ProgrammeTest, CountsRepeatedFrames) {
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn(0.01);
    ASSERT_TRUE(wait_for_ticks(40));
    programme_->stop();
    const ProgrammeStats stats = programme_->stats();
    EXPECT_EQ(stats.ticks, seen_->count()) << "sinks get every tick, also one that is repeated";
    const std::uint64_t due = stats.pictures + stats.reprojected + stats.repeated;
    EXPECT_LE(due, stats.ticks);
    EXPECT_GE(due, 35u) << "every tick had another camera";
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, ReprojectsTheLastFrameIfNoneIsReady) {
    ask_for_long_pictures();
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    // So slowly that hardly any frame is worth rendering, once frames are known to be long.
    camera_source_.turn(0.0001);
    const std::uint64_t first = programme_->stats().pictures;
    ASSERT_TRUE(eventually([&] { return programme_->stats().pictures >= first + 25; }));
    const ProgrammeStats before = programme_->stats();
    ASSERT_TRUE(
        eventually([&] { return programme_->stats().reprojected >= before.reprojected + 20; }));
    const ProgrammeStats after = programme_->stats();
    EXPECT_LT(after.pictures - before.pictures, after.reprojected - before.reprojected);
    {
        const std::lock_guard lock(seen_->mutex);
        int moved = 0;
        for (std::size_t i = 1; i < seen_->cameras.size(); ++i)
            moved += !is_same_view(seen_->cameras[i - 1], seen_->cameras[i]);
        EXPECT_GE(moved, 20) << "the camera of every tick";
        EXPECT_NEAR(seen_->last_middle[0], 200, 3);
    }
}

TEST_F(ProgrammeTest, RendersLongFramesForTheCameraOfTheirTicks) {
    ask_for_long_pictures();
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    constexpr double turn_rad = 0.004, furthest_rad = 0.8;
    camera_source_.turn(turn_rad, furthest_rad);
    const auto azimuth_rad = [](const MadePicture& made) {
        return orbit_view_of(made.job.camera, 0).azimuth_rad;
    };
    // A frame of an earlier camera would lag behind at all its ticks, except where the turn
    // reverses.
    int ahead = 0;
    std::shared_ptr<const MadePicture> last;
    EXPECT_TRUE(eventually([&] {
        const std::shared_ptr<const MadePicture> shown = programme_->state().picture;
        if (last && shown != last && shown->rendered) {
            const double rad = azimuth_rad(*shown), turned_rad = rad - azimuth_rad(*last);
            const double before_it_rad = azimuth_rad(*shown->rendered) - rad;
            ahead += std::abs(rad) < 0.75 * furthest_rad && turned_rad * before_it_rad > 0;
        }
        last = shown;
        return ahead >= 20;
    }));
}

TEST_F(ProgrammeTest, RendersALongFrameOnce) {
    ask_for_long_pictures();
    make();
    start();
    for (std::uint64_t pulse = 1; pulse <= 3; ++pulse) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
        ASSERT_TRUE(wait_for_ticks(60));
        EXPECT_EQ(programme_->stats().pictures, pulse);
    }
}

TEST_F(ProgrammeTest, RendersAFrameOnceTheCameraStands) {
    ask_for_long_pictures();
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn(0.0005);
    ASSERT_TRUE(eventually([&] { return programme_->stats().reprojected >= 5; }));
    camera_source_.turn(0);
    EXPECT_TRUE(eventually([&] {
        const ProgrammeStats before = programme_->stats();
        if (!wait_for_ticks(40) || programme_->stats().reprojected != before.reprojected ||
            programme_->stats().pictures != before.pictures)
            return false;
        const ProgrammeState state = programme_->state();
        return !state.picture->rendered &&
               is_same_view(state.picture->job.camera, state.view.camera());
    }));
}

TEST_F(ProgrammeTest, CutShowsTheFrameOfThePreviewFirst) {
    ask_for_long_pictures();
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    // Cut back and forth, until the reprojection is ready first.
    double azimuth_rad = 0.5;
    for (int cut = 0; cut < 100 && programme_->stats().reprojected == 0; ++cut) {
        camera_source_.next([&](CameraStep& step) {
            step.preview = step.view;
            step.preview->azimuth_rad = azimuth_rad;
        });
        ASSERT_TRUE(eventually([&] {
            const auto picture = programme_->state().preview.picture;
            return picture && std::abs(Reprojection::way(picture->job.camera,
                                                         programme_->state().view.camera())) > 0.4;
        }));
        camera_source_.next([&](CameraStep& step) { step.view.azimuth_rad = azimuth_rad; });
        ASSERT_TRUE(wait_for_ticks(40));
        azimuth_rad = azimuth_rad > 0 ? -0.1 : 0.5;
    }
    EXPECT_GT(programme_->stats().reprojected, 0u);
    const std::lock_guard lock(seen_->mutex);
    EXPECT_EQ(seen_->empty_pictures, 0);
}

TEST_F(ProgrammeTest, CutsToAViewOutOfReachOfReprojection) {
    make();
    push(1);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    const std::uint64_t pictures = programme_->stats().pictures;
    camera_source_.next([](CameraStep& step) { step.view.azimuth_rad += 0.5; });
    ASSERT_TRUE(eventually([&] { return programme_->stats().pictures > pictures; }));
    EXPECT_EQ(programme_->stats().reprojected, 0u);
}

TEST_F(ProgrammeTest, GpuResetCostsFramesButNoTick) {
    make();
    push(1, 200);
    start();
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn(0.001);
    ASSERT_TRUE(wait_for_ticks(20));
    for (int resets = 1; resets <= 2; ++resets) {
        reset_gpu();
        ASSERT_TRUE(eventually([&] {
            const auto newest = instants_->newest();
            return newest->generation == static_cast<std::uint64_t>(1 + resets);
        }));
        const std::uint64_t before = programme_->stats().pictures;
        ASSERT_TRUE(eventually([&] { return programme_->stats().pictures > before + 5; }));
    }
    const auto red = static_cast<unsigned char>(20);
    push(2, red);
    ASSERT_TRUE(wait_for_pulse(2));
    ASSERT_TRUE(wait_for_ticks(2));
    programme_->stop();
    EXPECT_EQ(contexts_.losses(), 2);
    const ProgrammeStats stats = programme_->stats();
    EXPECT_GT(stats.repeated + stats.reprojected, 0u) << "what was due meanwhile";
    EXPECT_EQ(stats.ticks, seen_->count());
    EXPECT_NEAR(seen_->last_middle[0], red, 2);
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, FailingSinkIsClosedAndReported) {
    make();
    const auto broken = std::make_shared<Seen>();
    programme_->add(std::make_unique<FailingSink>(3, broken));
    start();
    push(1);
    ASSERT_TRUE(wait_for_ticks(20));
    programme_->stop();
    EXPECT_EQ(broken->count(), 3u) << "it is asked no more";
    const std::vector<SinkState> sinks = programme_->stats().sinks;
    ASSERT_EQ(sinks.size(), 2u);
    EXPECT_EQ(sinks[0].failure, "");
    EXPECT_EQ(sinks[0].pictures, seen_->count());
    EXPECT_EQ(sinks[1].name, "broken line");
    EXPECT_EQ(sinks[1].failure, "the line is broken");
    EXPECT_EQ(sinks[1].pictures, 3u);
    EXPECT_TRUE(seen_->is_finished);
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, SinkThatFailsAtItsEndIsReported) {
    make();
    programme_->add(std::make_unique<FailingSink>(1'000'000, std::make_shared<Seen>()));
    start();
    push(1);
    ASSERT_TRUE(wait_for_ticks(2));
    programme_->stop();
    EXPECT_EQ(programme_->stats().sinks.at(1).failure, "the line did not end well");
    EXPECT_TRUE(seen_->is_finished);
}

TEST_F(ProgrammeTest, CountsMissedTicks) {
    make();
    programme_->add(std::make_unique<SlowSink>(500ms));
    start();
    push(1);
    ASSERT_TRUE(wait_for_ticks(8));
    programme_->stop();
    const ProgrammeStats stats = programme_->stats();
    EXPECT_GE(static_cast<double>(stats.missed), 0.5 * rate_hz - 2);
    EXPECT_GE(stats.late_ms.max, 400);
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, HoldKeepsTheInstantAndRefinesIt) {
    make_with_slow_preparer();
    start();
    // Instants that take longer than a pulse period are prepared at a cheaper level.
    *sleep_ms_ = 45;
    std::uint64_t pulse = 1;
    ASSERT_TRUE(eventually([&] {
        push(++pulse);
        std::this_thread::sleep_for(40ms);
        const auto picture = programme_->state().picture;
        return picture && picture->job.instant->instant->level > 0;
    }));
    camera_source_.next([](CameraStep& step) { step.time.commands = {command::ToggleHold{}}; });
    ASSERT_TRUE(eventually([&] { return programme_->state().time.is_held; }));
    *sleep_ms_ = 0;
    ASSERT_TRUE(eventually([&] {
        const auto picture = programme_->state().picture;
        return picture->job.instant->instant->level == 0 && picture->job.level.rank == 0;
    })) << "what stands still is shown as well as can be";
    EXPECT_EQ(programme_->state().render_level(), 0) << "of what is shown";
    EXPECT_EQ(programme_->state().prepare_level(), 0);
    EXPECT_EQ(programme_->stats().rest_ms.count, 1u);
    EXPECT_GT(programme_->stats().rest_ms.max, 0);
    const std::uint64_t held = shown_pulse();
    push(pulse + 10);
    const std::uint64_t before = programme_->stats().pictures;
    camera_source_.turn(0.01);
    ASSERT_TRUE(eventually([&] { return programme_->stats().pictures > before + 5; }));
    EXPECT_EQ(shown_pulse(), held) << "the camera flies and time stands";
    camera_source_.next([](CameraStep& step) { step.time.commands = {command::ToggleHold{}}; });
    EXPECT_TRUE(wait_for_pulse(pulse + 10)) << "what came meanwhile";
    EXPECT_FALSE(programme_->state().time.is_held);
}

TEST_F(ProgrammeTest, GoesThroughThePastAndBackToLive) {
    instants_settings_.replay_bytes = 100'000'000;
    make();
    start();
    for (std::uint64_t pulse = 1; pulse <= 5; ++pulse) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
    }
    EXPECT_FALSE(programme_->state().behind_s);
    camera_source_.next([](CameraStep& step) { step.time.pulses = -2; });
    ASSERT_TRUE(wait_for_pulse(3));
    EXPECT_NEAR(*programme_->state().behind_s, 2 / rate_hz, 1e-9);
    push(6);
    ASSERT_TRUE(eventually([&] { return *programme_->state().behind_s > 2.5 / rate_hz; }))
        << "it stands while the stage goes on";
    EXPECT_EQ(shown_pulse(), 3u);
    camera_source_.next([](CameraStep& step) { step.time.pulses = 1; });
    ASSERT_TRUE(wait_for_pulse(4));
    camera_source_.next([](CameraStep& step) { step.time.pulses = -100; });
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.next([](CameraStep& step) { step.time.pulses = 100; });
    ASSERT_TRUE(wait_for_pulse(6));
    camera_source_.next([](CameraStep& step) { step.time.commands = {command::ToLive{}}; });
    push(7);
    ASSERT_TRUE(wait_for_pulse(7));
    EXPECT_FALSE(programme_->state().behind_s);
}

TEST_F(ProgrammeTest, PlaysAClipWithItsShotAndReturnsToLive) {
    instants_settings_.replay_bytes = 1 << 20;
    ClipBook book;
    book.pulse_rate_hz = rate_hz;
    book.clips[1] = {.in = 2, .out = 4, .shot = 5};
    settings_.replay = Replay(Transport(), book);
    make();
    start();
    for (std::uint64_t pulse = 1; pulse <= 8; ++pulse) push(pulse);
    ASSERT_TRUE(wait_for_pulse(8));
    const Pose live = programme_->state().picture->job.camera.world_from_camera;
    camera_source_.next(
        [](CameraStep& step) { step.time.commands = {ReplayCall{ReplayAction::play_clip}}; });
    ASSERT_TRUE(wait_for_pulse(3));
    EXPECT_EQ(programme_->state().replay.mode, ReplayMode::clip);
    EXPECT_EQ(camera_source_.shot(), 5);
    camera_source_.next([](CameraStep& step) { step.time.commands = {command::ToLive{}}; });
    ASSERT_TRUE(eventually([&] { return !programme_->state().time.pulse; }));
    push(9);
    ASSERT_TRUE(wait_for_pulse(9));
    EXPECT_EQ(programme_->state().replay.mode, ReplayMode::live);
    EXPECT_EQ(programme_->state().picture->job.camera.world_from_camera.matrix(), live.matrix())
        << "no camera moved";
}

TEST_F(ProgrammeTest, MeasuresAJumpInTime) {
    instants_settings_.replay_bytes = 100'000'000;
    make();
    start();
    for (std::uint64_t pulse = 1; pulse <= 5; ++pulse) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
    }
    // Playing from the present position is not a jump.
    camera_source_.next([](CameraStep& step) { step.time.commands = {command::ChangeSpeed{1}}; });
    ASSERT_TRUE(eventually([&] { return programme_->state().time.pulse.has_value(); }));
    EXPECT_EQ(programme_->stats().seek_ms.count, 0u);
    for (std::uint64_t seek = 1; seek <= 3; ++seek) {
        const int pulses = seek == 2 ? 3 : -3;
        const std::uint64_t wanted = seek == 2 ? 5 : 2;
        camera_source_.next([&](CameraStep& step) { step.time.pulses = pulses; });
        ASSERT_TRUE(wait_for_pulse(wanted));
        ASSERT_TRUE(eventually([&] { return programme_->stats().seek_ms.count == seek; }));
    }
    const ProgrammeStats stats = programme_->stats();
    EXPECT_GT(stats.seek_ms.max, 0);
    // No part takes more than the whole, and preparing takes time.
    const SeekSteps<Percentiles>& steps = stats.seek_steps_ms;
    for (const Percentiles& step : {steps.wait, steps.fetch, steps.prepare, steps.picture}) {
        EXPECT_EQ(step.count, 3u);
        EXPECT_LE(step.max, stats.seek_ms.max);
    }
    EXPECT_GT(steps.prepare.max, 0);
}

TEST_F(ProgrammeTest, PausedFrameWaitsBetweenSlices) {
    make();
    push(1);
    ASSERT_TRUE(eventually([&] { return instants_->newest() != nullptr; }));
    const SynthesiserEntry entry = find_synthesiser(settings_.synthesiser);
    PictureMaker still(entry, settings_.format, contexts_, instants_->render_priority(),
                       PictureMaker::Manner::in_slices);
    PictureMaker other(entry, settings_.format, contexts_, instants_->render_priority());
    ASSERT_TRUE(eventually([&] { return still.is_idle() && other.is_idle(); }));
    const PictureJob job{instants_->newest(), {}, render_levels().front()};
    still.pause(true);
    still.start(job);
    other.start(job);
    ASSERT_TRUE(eventually([&] { return other.take_finished() != nullptr; }));
    EXPECT_EQ(still.take_finished(), nullptr);
    EXPECT_FALSE(still.is_idle());
    still.pause(false);
    EXPECT_TRUE(eventually([&] { return still.take_finished() != nullptr; }));
    // A paused renderer can be ended.
    still.pause(true);
    ASSERT_TRUE(eventually([&] { return still.is_idle(); }));
    still.start(job);
}

TEST_F(ProgrammeTest, HeldFrameSetStaysAfterTheReplayBufferDropsIt) {
    constexpr std::size_t set_bytes = 2 * 46 * 62 * (4 + 2);
    instants_settings_.replay_bytes = 3 * set_bytes;
    make();
    start();
    for (std::uint64_t pulse = 1; pulse <= 3; ++pulse) {
        push(pulse);
        ASSERT_TRUE(wait_for_pulse(pulse));
    }
    camera_source_.next([](CameraStep& step) { step.time.pulses = -2; });
    ASSERT_TRUE(wait_for_pulse(1));
    for (std::uint64_t pulse = 4; pulse <= 12; ++pulse) push(pulse);
    ASSERT_TRUE(eventually([&] { return instants_->past_span()->oldest == 10; }));
    const std::uint64_t before = programme_->stats().pictures;
    camera_source_.turn(0.01);
    ASSERT_TRUE(eventually([&] { return programme_->stats().pictures > before + 10; }));
    EXPECT_EQ(shown_pulse(), 1u);
}

TEST_F(ProgrammeTest, SwitchesTheSynthesiserWithoutAGap) {
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.turn(0.001);
    ASSERT_TRUE(wait_for_ticks(3));
    const std::string before = programme_->state().synthesiser;
    camera_source_.next([](CameraStep& step) { step.next_synthesiser = true; });
    ASSERT_TRUE(eventually([&] {
        const ProgrammeState state = programme_->state();
        return state.synthesiser != before &&
               state.picture->job.instant->synthesiser == state.synthesiser;
    }));
    push(2, 20);
    ASSERT_TRUE(wait_for_pulse(2));
    ASSERT_TRUE(wait_for_ticks(3));
    // Back, and to it again: no old frame is shown.
    const std::string after = programme_->state().synthesiser;
    camera_source_.next([](CameraStep& step) { step.next_synthesiser = true; });
    ASSERT_TRUE(eventually([&] { return programme_->state().synthesiser != after; }));
    push(3, 120);
    ASSERT_TRUE(wait_for_pulse(3));
    ASSERT_TRUE(wait_for_ticks(3));
    programme_->stop();
    expect_every_tick_once();
    EXPECT_EQ(programme_->stats().faults, 0);
    EXPECT_NEAR(seen_->last_middle[0], 120, 2);
}

TEST_F(ProgrammeTest, ShowsTheSourceMapWhileItIsSwitchedOn) {
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    EXPECT_FALSE(programme_->state().picture->sources);
    const auto toggle = [](CameraStep& step) { step.toggle_source_map = true; };
    camera_source_.next(toggle);
    ASSERT_TRUE(eventually([&] { return programme_->state().picture->sources.has_value(); }));
    const SourceMap sources = *programme_->state().picture->sources;
    EXPECT_EQ(sources.shares.rigs.size(), 2u);
    EXPECT_EQ(sources.legend.size(), 2u);
    EXPECT_TRUE(programme_->state().source_map);
    camera_source_.next(toggle);
    ASSERT_TRUE(eventually([&] { return !programme_->state().picture->sources; }));
}

TEST_F(ProgrammeTest, MeasuresInputLatency) {
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    EXPECT_EQ(programme_->stats().input_ms.count, 0u);
    camera_source_.next([](CameraStep& step) {
        step.view.azimuth_rad = 0.1;
        step.input = MonotonicClock::now();
    });
    ASSERT_TRUE(eventually([&] { return programme_->stats().input_ms.count == 1; }));
    EXPECT_GT(programme_->stats().input_ms.max, 0);
}

TEST_F(ProgrammeTest, HasNoLatencyForInputThatChangesNoFrame) {
    settings_.quality = {3};  // another level would be another frame
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    camera_source_.next([](CameraStep& step) { step.input = MonotonicClock::now(); });
    ASSERT_TRUE(wait_for_ticks(3));
    camera_source_.next([](CameraStep& step) { step.view.azimuth_rad = 0.1; });
    const std::uint64_t pictures = programme_->stats().pictures;
    ASSERT_TRUE(eventually([&] { return programme_->stats().pictures > pictures; }));
    EXPECT_EQ(programme_->stats().input_ms.count, 0u) << "its time is not the later picture's";
}

TEST_F(ProgrammeTest, HasNoLatencyForMarks) {
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    const auto mark = [](CameraStep& step) {
        step.input = MonotonicClock::now();
        step.time.commands = {command::MarkIn{}};
    };
    // At every step, and so also at those that start a frame.
    for (std::uint64_t pulse = 2; pulse < 8; ++pulse) {
        push(pulse);
        ASSERT_TRUE(eventually([&] {
            camera_source_.next(mark);
            return shown_pulse() == pulse;
        }));
    }
    EXPECT_EQ(programme_->stats().input_ms.count, 0u) << "pictures are new, but not of the hand";
}

TEST_F(ProgrammeTest, KeepsTheRequestedQuality) {
    settings_.quality = {3};
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    const std::shared_ptr<const MadePicture> picture = programme_->state().picture;
    EXPECT_EQ(picture->job.level.rank, 3);
    EXPECT_EQ(picture->picture.size(), cv::Size(64, 48)) << "whatever size is rendered";
    EXPECT_NEAR(picture->picture(24, 32)[0], 200, 3);
}

TEST_F(ProgrammeTest, RendersStereoscopicEyesSideBySide) {
    settings_.format.stereoscopy = Stereoscopy{};
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    const ColourImage picture = programme_->state().picture->picture;
    EXPECT_EQ(picture.size(), cv::Size(64, 48));
    EXPECT_GE(picture(24, 16)[3], 128) << "the middle of the left eye's half";
    EXPECT_GE(picture(24, 48)[3], 128) << "the middle of the right eye's half";
}

/// Without a background the hull is black, and not a fault that recreates the renderer.
TEST_F(ProgrammeTest, StaysBlackIfASynthesiserLacksItsInput) {
    settings_.synthesiser = "hull";
    make();
    start();
    push(1);
    ASSERT_TRUE(wait_for_pulse(1));
    const ColourImage picture = programme_->state().picture->picture;
    EXPECT_LT(picture(24, 32)[0], 100);
    EXPECT_EQ(programme_->stats().faults, 0);
}

TEST_F(ProgrammeTest, EndsWithItsPlan) {
    make();
    push(1);
    programme_->start([](std::uint64_t pictures, double) { return pictures >= 12; });
    camera_source_.turn(0.01);
    ASSERT_TRUE(eventually([&] { return programme_->is_over(); }));
    programme_->stop();
    const ProgrammeStats stats = programme_->stats();
    EXPECT_GE(stats.ticks, 12u);
    expect_every_tick_once();
}

TEST_F(ProgrammeTest, ThrowsTheErrorThatEndedIt) {
    make();
    start();
    EXPECT_FALSE(programme_->is_over());
    camera_source_.fail_with("the deck broke");
    EXPECT_TRUE(eventually([&] {
        try {
            return programme_->is_over();
        } catch (const Error& error) {
            return std::string(error.what()) == "the deck broke";
        }
    }));
}

TEST_F(ProgrammeTest, ThrowsTheErrorOfTheFeed) {
    feed_.fail_with("the receiver broke");
    make();
    start();
    EXPECT_TRUE(eventually([&] {
        try {
            return programme_->is_over();
        } catch (const Error& error) {
            return std::string(error.what()) == "the receiver broke";
        }
    }));
}

}  // namespace
}  // namespace vantage
