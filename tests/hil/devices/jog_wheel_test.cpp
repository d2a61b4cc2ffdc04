#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "host_app/control/hid/simulated_wheel.h"
#include "tests/hil/devices/uinput_wheel.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/eventually.h"
#include "tests/support/source_folder.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

class JogWheel : public testing::Test {
  protected:
    void SetUp() override {
        if (access("/dev/uhid", W_OK) != 0) GTEST_SKIP() << "SKIPPED: /dev/uhid is not there";
    }

    static UhidWheel::Kind xpress() {
        return {0x0b33, 0x0020, "Contour Design ShuttleXpress", UhidWheel::five_bytes(), {}, {}};
    }
    static UhidWheel::Kind unknown_wheel() {
        return {0x1209, 0xb0b0, "Workshop wheel", UhidWheel::five_bytes(), {}, {}};
    }
    std::string describe_unknown_wheel() const {
        const std::string file = (folder_.path() / "workshop.toml").string();
        std::ofstream(file) << "version = 1\nname = \"Workshop\"\ndevices = [\"1209:b0b0\"]\n"
                               "[[report]]\nname = \"jog\"\nkind = \"delta\"\nbyte = 2\n"
                               "[[report]]\nname = \"b\"\nkind = \"buttons\"\nbyte = 4\n"
                               "[axes.jog]\naction = \"wheel\"\n[buttons]\nb8 = \"freeze\"\n";
        return file;
    }
    /// Emulation is slow, so that an event may take minutes.
    template <class Condition>
    static bool eventually(const Condition& condition) {
        return vantage::eventually(condition, 10min, 50ms);
    }
    /// Waits for a part of what the program says behind `read`, and moves that behind the part.
    static bool eventually_prints(const ChildProgram& program, std::size_t& read,
                                  const std::string& part) {
        return eventually([&] {
            const std::size_t found = program.out().find(part, read);
            if (found != std::string::npos) read = found + part.size();
            return found != std::string::npos;
        });
    }
    static bool holds(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
    std::unique_ptr<ChildProgram> monitor(std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"jog", "monitor"});
        return std::make_unique<ChildProgram>(VANTAGE_PROGRAM, more, folder_.path());
    }
    /// `vantage jog list` as a user without rights of his own but those of a group.
    ProgramResult list_as(const std::string& group, const std::string& wheels) {
        return run_to_end("/usr/bin/setpriv",
                          {"--reuid=nobody", "--regid=" + group, "--clear-groups", VANTAGE_PROGRAM,
                           "jog", "list", "--wheels", wheels});
    }

    TemporaryFolder folder_;
};

TEST_F(JogWheel, CanBeTriedWithoutOne) {
    const auto watching = monitor();
    ASSERT_TRUE(eventually([&] { return holds(watching->err(), "move a jog wheel"); }));
    const std::filesystem::path words = folder_.path() / "words";
    std::ofstream(words) << "wait 1\nnonsense\njog 2\nshuttle -7\nb3\nwait 1\n";
    const ProgramResult simulated = run_to_end(
        "/bin/sh",
        {"-c", std::string(VANTAGE_PROGRAM) + " jog simulate --json <" + words.string()});
    EXPECT_EQ(simulated.status, 0) << simulated.err;
    EXPECT_THAT(simulated.err, HasSubstr("'nonsense' is not understood"));
    for (const char* line : {R"({"event":"plugged","name":"Contour Design ShuttleXpress"})",
                             R"({"event":"moved","words":"jog 2","reports":[[0,0,0,0,0],[0,1,)"})
        EXPECT_THAT(simulated.out, HasSubstr(line));
    EXPECT_TRUE(eventually([&] { return holds(watching->out(), "disconnected from"); }))
        << watching->out();
    for (const char* event : {"ShuttleXpress  connected", "jog +1", "shuttle -1", "b3 pressed"})
        EXPECT_THAT(watching->out(), HasSubstr(event));
}

TEST_F(JogWheel, ReportsComeThroughTheKernelAsEvents) {
    std::optional<UhidWheel> wheel(xpress());
    const auto program = monitor();
    ASSERT_TRUE(eventually([&] { return holds(program->out(), "connected at"); }))
        << program->err();
    wheel->send({0, 100, 0, 0, 0});
    wheel->send({0, 103, 0, 0x10, 0});
    wheel->send({0xfe, 103, 0, 0, 0});
    EXPECT_TRUE(eventually([&] { return holds(program->out(), "shuttle -0.286"); }));
    EXPECT_THAT(program->out(), HasSubstr("jog +3"));
    EXPECT_THAT(program->out(), HasSubstr("b1 pressed"));
    EXPECT_THAT(program->out(), HasSubstr("b1 released"));
    wheel.reset();
    EXPECT_TRUE(eventually([&] { return holds(program->out(), "disconnected from"); }))
        << program->out();
    program->send_signal(SIGINT);
    EXPECT_EQ(program->wait().status, 130);
}

TEST_F(JogWheel, AWheelOfEachHidFamilyIsPluggedInAndOutAndInAgain) {
    struct Wheel {
        UhidWheel::Kind kind;
        std::vector<std::vector<std::uint8_t>> reports;
        std::string event;
    };
    std::vector<std::uint8_t> xk68(36);
    xk68[16] = 0xfe;
    // A multi-axis controller with the reports 1 to 3 and the lamp's.
    const std::vector<std::uint8_t> six_axes = {
        0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75,
        0x08, 0x85, 0x01, 0x09, 0x01, 0x95, 0x06, 0x81, 0x02, 0x85, 0x02, 0x09,
        0x01, 0x95, 0x06, 0x81, 0x02, 0x85, 0x03, 0x09, 0x01, 0x95, 0x02, 0x81,
        0x02, 0x85, 0x04, 0x09, 0x01, 0x95, 0x01, 0x91, 0x02, 0xc0};
    const std::vector<Wheel> wheels = {
        {{0x0b33, 0x0030, "ShuttlePRO v2", UhidWheel::five_bytes(), {}, {}},
         {{0, 10, 0, 0, 0}, {0, 12, 0, 0, 0}},
         R"("control":"jog","value":2.0)"},
        {{0x05f3, 0x0426, "XK-12", UhidWheel::input_of(12), {}, {}},
         {{0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 9}},
         R"("control":"jog","value":3.0)"},
        {{0x05f3, 0x045a, "XK-68", UhidWheel::input_of(36), {}, {}},
         {xk68},
         R"("control":"jog","value":-2.0)"},
        {{0x256f, 0xc635, "SpaceMouse Compact", six_axes, {}, {}},
         {{1, 0x5e, 0x01, 0, 0, 0, 0}},
         R"("control":"tx","value":1.0)"}};
    for (const Wheel& wheel : wheels) {
        const auto program = monitor({"--json"});
        std::size_t read = 0;
        const auto comes_next = [&](const std::string& part) {
            return eventually_prints(*program, read, part);
        };
        for (int time = 0; time < 2; ++time) {
            const UhidWheel plugged(wheel.kind);
            ASSERT_TRUE(comes_next(R"("event":"plugged")")) << wheel.kind.name << program->err();
            for (const auto& report : wheel.reports) plugged.send(report);
            EXPECT_TRUE(comes_next(wheel.event)) << wheel.kind.name << program->out();
        }
        EXPECT_TRUE(comes_next(R"("event":"lost")")) << wheel.kind.name << program->out();
    }
}

TEST_F(JogWheel, APowerMateIsReadAsTheInputDeviceThatTheKernelMakesOfIt) {
    std::filesystem::permissions(folder_.path(), std::filesystem::perms::all);
    const auto program = monitor({"--json"});
    std::size_t read = 0;
    const auto comes_next = [&](const std::string& part) {
        return eventually_prints(*program, read, part);
    };
    for (int time = 0; time < 2; ++time) {
        const UinputWheel wheel;
        ASSERT_TRUE(comes_next(R"("event":"plugged")")) << program->err();
        wheel.turn(-3);
        EXPECT_TRUE(comes_next(R"("control":"jog","value":-3.0)")) << program->out();
        wheel.press(true);
        EXPECT_TRUE(comes_next(R"("control":"press","value":1.0)")) << program->out();
        wheel.press(false);
        EXPECT_TRUE(comes_next(R"("control":"press","value":0.0)")) << program->out();
        const std::string others = list_as("nogroup", describe_unknown_wheel()).out;
        EXPECT_THAT(others, HasSubstr("Griffin PowerMate"));
        EXPECT_THAT(others, HasSubstr("may not be opened by this user: copy "
                                      "udev/70-vantage-jog.rules"));
    }
    EXPECT_TRUE(comes_next(R"("event":"lost")")) << program->out();
}

TEST_F(JogWheel, OneThatIsOnlyDescribedIsReadToo) {
    const UhidWheel wheel(unknown_wheel());
    const auto program = monitor({"--wheels", describe_unknown_wheel(), "--json"});
    ASSERT_TRUE(eventually([&] { return holds(program->out(), "plugged"); })) << program->err();
    wheel.send({9, 9, 0xfd, 9, 0x80});
    EXPECT_TRUE(eventually([&] { return holds(program->out(), R"("control":"b8","value":1.0)"); }));
    EXPECT_THAT(program->out(), HasSubstr(R"("control":"jog","value":-3.0)"));
}

TEST_F(JogWheel, RulesLetAnOperatorUseItAndAFaultNamesThem) {
    const UhidWheel known(xpress()), other(unknown_wheel());
    const std::string described = describe_unknown_wheel();
    std::filesystem::permissions(folder_.path(), std::filesystem::perms::all);
    ProgramResult result;
    EXPECT_TRUE(eventually([&] {
        result = list_as("input", described);
        return holds(result.out, "ShuttleXpress  ready");
    })) << result.out
        << result.err;
    EXPECT_THAT(result.out, HasSubstr("may not be opened by this user: copy "
                                      "udev/70-vantage-jog.rules"))
        << "no rule names the workshop's wheel";
    EXPECT_THAT(list_as("nogroup", described).out, Not(HasSubstr("ready")));
}

TEST_F(JogWheel, OpensASpeedEditorByItsHandshake) {
    UhidWheel::Kind kind{0x1edb, 0xda0e, "DaVinci Resolve Speed Editor", {}, {}, {}};
    kind.descriptor = {0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75,
                       0x08, 0x85, 0x03, 0x09, 0x01, 0x95, 0x06, 0x81, 0x02, 0x09, 0x01, 0x95, 0x06,
                       0x91, 0x02, 0x85, 0x04, 0x09, 0x01, 0x95, 0x0c, 0x81, 0x02, 0x09, 0x01, 0x95,
                       0x01, 0x91, 0x02, 0x85, 0x06, 0x09, 0x01, 0x95, 0x09, 0xb1, 0x02, 0xc0};
    // The device as its procedure is known: it takes the answer to its challenge, and only then
    // does it talk.
    constexpr std::uint64_t right_answer = 0xe5c7b689e9967608;
    auto step = std::make_shared<std::atomic<int>>(-1);
    auto answer = std::make_shared<std::atomic<std::uint64_t>>(0);
    kind.set_feature = [step, answer](std::span<const std::uint8_t> report) {
        if (report.size() < 10) return;
        step->store(report[1]);
        std::uint64_t number = 0;
        for (std::size_t i = 10; i-- > 2;) number = number << 8 | report[i];
        if (report[1] == 3) answer->store(number);
    };
    kind.get_feature = [step, answer](std::uint8_t) -> std::vector<std::uint8_t> {
        if (*step == 0) return {6, 0, 0xef, 0xcd, 0xab, 0x89, 0x67, 0x45, 0x23, 0x01};
        if (*step == 1) return {6, 2, 0, 0, 0, 0, 0, 0, 0, 0};
        if (*step == 3 && *answer == right_answer) return {6, 4, 0x58, 0x02, 0, 0, 0, 0, 0, 0};
        return {};
    };
    const auto program = monitor();
    std::size_t read = 0;
    for (int time = 0; time < 2; ++time) {
        answer->store(0);
        const UhidWheel wheel(kind);
        ASSERT_TRUE(eventually_prints(*program, read, "connected at")) << program->err();
        ASSERT_EQ(answer->load(), right_answer) << "it is silent";
        wheel.send({3, 0, 0x00, 0x01, 0, 0, 255});
        EXPECT_TRUE(eventually_prints(*program, read, "jog +1")) << program->out();
        wheel.send({4, 0x1a, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
        EXPECT_TRUE(eventually_prints(*program, read, "source pressed")) << program->out();
    }
    EXPECT_TRUE(eventually_prints(*program, read, "disconnected from")) << program->out();
}

TEST_F(JogWheel, FliesTheVirtualCameraAndHoldsItWhileItIsUnplugged) {
    const auto file = [&](const char* name) { return (folder_.path() / name).string(); };
    // A pulse every five seconds: under emulation a picture of the stage takes seconds.
    std::ofstream(file("rig.toml"))
        << "version = 1\nname = \"rig\"\n[source]\nrate_hz = 0.2\nwidth_px = 80\nheight_px = 60\n"
        << "[match]\nmatcher = \"exact\"\ndisparities = 32\n"
        << "[stream]\nbind = \"tcp://127.0.0.1:5690\"\n";
    std::ofstream(file("stage.toml"))
        << "version = 1\nrate_hz = 0.2\nlatency_budget_ms = 60000\n[view]\nwidth_px = 64\n"
        << "height_px = 36\nsynthesiser = \"mesh\"\n[[rigs]]\nname = \"rig\"\n"
        << "endpoint = \"tcp://127.0.0.1:5690\"\n";
    const TemporaryFolder rig_folder;
    ChildProgram rig(VANTAGE_RIG_PROGRAM, {"run", "--config", file("rig.toml")}, rig_folder.path());
    std::optional<UhidWheel> wheel(xpress());
    ChildProgram live(VANTAGE_PROGRAM,
                      {"live", "--stage", file("stage.toml"), "--headless", "--jog", "--rate", "4",
                       "--wait", "300", "--seconds", "900", "--json"},
                      folder_.path());
    const auto camera_is_at = [&](const std::string& azimuth) {
        const std::string log = live.err();
        const std::size_t last = log.rfind("azimuth ");
        return last != std::string::npos && log.compare(last + 8, azimuth.size(), azimuth) == 0;
    };
    ASSERT_TRUE(eventually([&] { return holds(live.err(), "is ready"); })) << live.err();
    ASSERT_TRUE(eventually([&] { return camera_is_at("0.0 "); })) << live.err() << rig.err();
    wheel->send({0, 250, 0, 0, 0});
    wheel->send({0, 14, 0, 0, 0});
    EXPECT_TRUE(eventually([&] { return camera_is_at("20.0 "); })) << live.err();

    wheel->send({0x07, 14, 0, 0, 0});
    EXPECT_TRUE(eventually([&] { return !camera_is_at("20.0 "); }))
        << "the ring is held at its end";
    wheel.reset();
    ASSERT_TRUE(eventually([&] { return holds(live.err(), "is gone"); })) << live.err();
    // Two looks at it after the last of the movement; one is logged every two seconds.
    std::this_thread::sleep_for(5s);
    const auto azimuth_now = [&] {
        const std::string log = live.err();
        return std::stod(log.substr(log.rfind("azimuth ") + 8));
    };
    const double held = azimuth_now();
    EXPECT_GT(held, 21);
    std::this_thread::sleep_for(5s);
    EXPECT_EQ(azimuth_now(), held) << live.err();

    wheel.emplace(xpress());
    ASSERT_TRUE(eventually([&] {
        return live.err().rfind("is ready") > live.err().find("is gone");
    })) << live.err();
    wheel->send({0, 3, 0, 0, 0});
    wheel->send({0, 0, 0, 0, 0});
    EXPECT_TRUE(eventually([&] { return std::abs(azimuth_now() - (held - 3)) < 0.11; }))
        << live.err();
    live.send_signal(SIGINT);
    const ProgramResult result = live.wait();
    ASSERT_EQ(result.status, 130) << result.err;
    const nlohmann::json summary = nlohmann::json::parse(result.out);
    std::printf("hil: wheel %s camera %s\n", summary["wheels"].dump().c_str(),
                summary["camera"].dump().c_str());
    EXPECT_NEAR(summary["camera"]["azimuth_deg"].get<double>(), held - 3, 0.1);
    ASSERT_EQ(summary["wheels"].size(), 1u);
    EXPECT_EQ(summary["wheels"][0]["unread"], 0);
}

}  // namespace
}  // namespace vantage
