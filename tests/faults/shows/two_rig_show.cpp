#include "tests/faults/shows/two_rig_show.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>

#include <fmt/format.h>

#include "common/receive/stage_receiver.h"
#include "common/wire/curve_keys.h"
#include "common/wire/limits.h"
#include "tests/support/eventually.h"
#include "tests/support/free_ports.h"
#include "tests/support/http_answer.h"

namespace vantage {

void TwoRigShow::SetUp() {
    if (const std::string reason = ImpairedRoad::reason_against(); !reason.empty())
        GTEST_SKIP() << "SKIPPED: " << reason;
    road_ = std::make_unique<ImpairedRoad>();
    // The loader parts its list at spaces, which a checkout's path may have.
    std::filesystem::create_symlink(VANTAGE_CLOCK_SET, file("clock_set.so"));
    const CurveKeys host_keys = generate_curve_keys(), rig_keys = generate_curve_keys();
    write_key_file(file("host.key"), host_keys);
    write_key_file(file("rig.key"), rig_keys);
    std::ofstream(file("hosts.keys")) << host_keys.public_key << " the host\n";
    near_endpoint_ = fmt::format("tcp://127.0.0.1:{}", two_free_ports().first);
    far_entry_ =
        fmt::format("[[rigs]]\nname = \"far\"\nendpoint = \"tcp://{}:5600\"\npublic_key = \"{}\"\n",
                    ImpairedRoad::rig_address, rig_keys.public_key);
    near_entry_ = fmt::format("[[rigs]]\nname = \"near\"\nendpoint = \"{}\"\n", near_endpoint_);
    std::ofstream(file("stage.toml")) << stage_head << far_entry_ << near_entry_ << stage_view;
    far_ = start_far();
    near_ = start_rig("near", 12, fmt::format("bind = \"{}\"\n", near_endpoint_));
    far_->wait_for("publishing on");
    near_->wait_for("publishing on");
}

void TwoRigShow::TearDown() {
    host_.reset();
    far_.reset();
    near_.reset();
}

std::unique_ptr<ChildProgram> TwoRigShow::start_rig(const std::string& name, double azimuth_deg,
                                                    const std::string& stream) {
    std::ofstream(file(name + ".toml"))
        << "version = 1\nname = \"" << name
        << "\"\n[source]\nrate_hz = 5\nwidth_px = 96\nheight_px = 72\n"
        << "[virtual_rig]\nazimuth_deg = " << azimuth_deg
        << "\n[match]\nmatcher = \"exact\"\ndisparities = 32\n[stream]\n"
        << stream;
    return std::make_unique<ChildProgram>(
        VANTAGE_RIG_PROGRAM,
        std::vector<std::string>{"run", "--config", file(name + ".toml"), "--json"}, folder_.path(),
        std::vector<std::string>{"LD_PRELOAD=" + file("clock_set.so"),
                                 fmt::format("CLOCK_SET_MS={}", clock_set_ms_)});
}

std::unique_ptr<ChildProgram> TwoRigShow::start_far() {
    std::unique_ptr<ChildProgram> rig;
    road_->at_the_rigs([&] {
        rig = start_rig("far", -12,
                        "bind = \"tcp://*:5600\"\nkey_file = \"rig.key\"\n"
                        "authorized_hosts = \"hosts.keys\"\nroad = \"" +
                            far_road() + "\"\n");
    });
    return rig;
}

void TwoRigShow::start_host(const std::vector<std::string>& options, const std::string& stage,
                            const std::vector<std::string>& environment) {
    std::vector<std::string> arguments{"live",
                                       "--stage",
                                       file(stage),
                                       "--headless",
                                       "--json",
                                       "--wait",
                                       "60",
                                       "--synth",
                                       "mesh",
                                       "--rate",
                                       "10",
                                       "--metrics",
                                       fmt::format("http://:{}", metrics_port)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    host_ = std::make_unique<ChildProgram>(VANTAGE_PROGRAM, arguments, folder_.path(), environment);
}

bool TwoRigShow::far_is(const std::string& state) const {
    const std::string log = host_->err();
    const auto last = [&](const std::string& word) {
        const std::size_t at = log.rfind("rig far is " + word);
        return at == std::string::npos ? -1 : static_cast<std::ptrdiff_t>(at);
    };
    const std::string other = state == "gone" ? "connected" : "gone";
    return last(state) > last(other);
}

std::size_t TwoRigShow::count_of(const std::string& words) const {
    const std::string log = host_->err();
    std::size_t count = 0;
    for (std::size_t at = log.find(words); at != std::string::npos; at = log.find(words, at + 1))
        ++count;
    return count;
}

void TwoRigShow::wait_for_progress() {
    const std::size_t now = progress();
    ASSERT_TRUE(eventually([&] { return progress() > now; })) << host_->err();
}

TwoRigShow::Sets TwoRigShow::next_frame_sets() {
    std::string text;
    EXPECT_TRUE(eventually([&] {
        text = http_answer(metrics_port, "GET", "/metrics");
        text.erase(0, text.find("\r\n\r\n"));
        return !text.empty() && text != last_word_;
    }));
    last_word_ = text;
    const auto count = [&](const std::string& rig) {
        const std::regex line("vantage_rig_frames_total\\{rig=\"" + rig +
                              "\",place=\"host\",result=\"in_sets\"\\} ([0-9]+)");
        std::smatch found;
        return std::regex_search(text, found, line) ? std::stoi(found[1]) : 0;
    };
    return {count("far"), count("near")};
}

int TwoRigShow::sets_until_far_is_back(const std::function<void()>& end_trouble) {
    (void)next_frame_sets();  // of whenever the host said it
    const Sets at_first = next_frame_sets();
    end_trouble();
    Sets before = at_first;
    while (true) {
        const Sets now = next_frame_sets();
        const int missed = now.near - at_first.near - (now.far - at_first.far);
        const bool is_back =
            now.near > before.near && now.far - before.far >= now.near - before.near;
        if (is_back || missed > 10 * sets_to_recover || HasFailure()) return missed;
        before = now;
    }
}

int TwoRigShow::frames_beside_until_both_are_back(const std::function<void()>& end_trouble) {
    StageConfig stage;
    stage.rate_hz = 5;
    stage.rigs.push_back({"near", near_endpoint_, ""});
    std::atomic<int> frames = 0;
    StageReceiver beside(stage, StageReceiver::Purpose::observe,
                         [&](const ArrivedFrame&) { ++frames; });
    beside.ask("near", true, 1);
    EXPECT_TRUE(eventually([&] { return frames > 0; }));
    const int at_first = frames;
    end_trouble();
    Sets before = next_frame_sets();
    while (true) {
        const int frames_before = frames;
        const Sets now = next_frame_sets();
        // The host said its word somewhat before it was heard.
        const int due = frames - frames_before - 1;
        const bool are_back =
            due > 0 && std::min(now.far - before.far, now.near - before.near) >= due;
        const int missed = frames_before - at_first;
        if (are_back || missed > 10 * sets_to_recover || HasFailure()) return missed;
        before = now;
    }
}

void TwoRigShow::expect_ticks_held(const nlohmann::json& summary) {
    EXPECT_GE(summary["pictures"], 20);
    EXPECT_LE(summary["missed_ticks"].get<double>(), 1 + 0.02 * summary["pictures"].get<double>())
        << summary["tick_late_ms"];
}

double TwoRigShow::named_by_host(const std::string& words) const {
    host_->wait_for(words);
    const std::string log = host_->err();
    return std::atof(log.c_str() + log.find(words) + words.size());
}

void TwoRigShow::expect_no_frame_lost(const nlohmann::json& summary) {
    for (const nlohmann::json& rig : summary["rigs"]) {
        EXPECT_EQ(rig["outages"]["count"], 0);
        EXPECT_EQ(rig["host"]["out_of_step"], 0);
        EXPECT_EQ(rig["link"]["lost"], 0);
        expect_balanced(rig);
    }
}

void TwoRigShow::expect_balanced(const nlohmann::json& rig) {
    const auto count = [&](const char* place, const char* what) {
        return rig[place][what].get<std::int64_t>();
    };
    EXPECT_EQ(count("host", "in_frame_sets"),
              count("host", "fused") + count("host", "replaced") + count("host", "in_dropped_sets"))
        << rig;
    const std::int64_t open = count("host", "received") - count("host", "in_frame_sets") -
                              count("host", "late") - count("host", "duplicate") -
                              count("host", "unsynchronized") - count("host", "out_of_step");
    EXPECT_GE(open, 0) << rig;
    EXPECT_LE(open, 5 + 1) << "the frames of the latency budget: " << rig;
    const std::int64_t under_way = count("link", "sent") - count("link", "lost") -
                                   count("host", "received") - count("host", "queue_dropped");
    EXPECT_GE(under_way, 0) << rig;
    EXPECT_LE(under_way, max_credit_window) << "the credits of a host: " << rig;
    const std::int64_t waiting = count("link", "offered") - count("link", "sent") -
                                 count("link", "send_dropped") - count("link", "skipped");
    EXPECT_GE(waiting, 0) << rig;
    EXPECT_LE(waiting, 4) << "the queue of a host: " << rig;
    EXPECT_EQ(count("host", "undecodable"), 0) << rig;
}

void TwoRigShow::expect_unharmed(ChildProgram& rig) {
    rig.send_signal(SIGTERM);
    const ProgramResult end = rig.wait();
    EXPECT_EQ(end.status, 0) << end.err;
    const nlohmann::json own = nlohmann::json::parse(end.out);
    EXPECT_EQ(own["captured"].get<std::int64_t>(),
              own["published"].get<std::int64_t>() + own["late"].get<std::int64_t>())
        << own;
    for (const nlohmann::json& host : own["hosts"]) {
        const auto waiting =
            host["offered"].get<std::int64_t>() - host["sent"].get<std::int64_t>() -
            host["send_dropped"].get<std::int64_t>() - host["skipped"].get<std::int64_t>();
        EXPECT_GE(waiting, 0) << own;
        EXPECT_LE(waiting, 4) << "the queue of a host: " << own;
    }
}

}  // namespace vantage
