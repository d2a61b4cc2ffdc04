#include "tests/faults/hostile_rig.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>
#include <zmq_addon.hpp>

#include "common/base/error.h"
#include "common/geometry/pose.h"
#include "common/wire/codec/disparity_codec.h"
#include "common/wire/limits.h"
#include "tests/support/wire_frames.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr int small_width_px = 96, small_height_px = 72;

enum Kind {
    right,
    slightly_ahead,
    far_ahead,
    long_past,
    twice,
    other_size,
    largest_size,
    other_lens,
    other_place,
    other_time,
    raw_pair,
    without_pulse,
    other_name,
    wild_depth,
    impossible_sync,
    impossible_counts,
    new_session,
    refusal,
    unasked,
    damaged,
};
static_assert(damaged + 1 == HostileRig::kinds);

}  // namespace

HostileRig::HostileRig(std::string name, std::chrono::nanoseconds period, unsigned seed)
    : name_(std::move(name)),
      period_(period),
      random_(seed),
      socket_(context_, zmq::socket_type::router) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.set(zmq::sockopt::curve_server, true);
    socket_.set(zmq::sockopt::curve_secretkey, keys_.secret_key);
    socket_.bind("tcp://127.0.0.1:*");
    endpoint_ = socket_.get(zmq::sockopt::last_endpoint);
    huge_ =
        DisparityEncoder().encode(DisparityImage::zeros(max_picture_side_px, max_picture_side_px));
    thread_ = std::thread([this] { run(); });
}

HostileRig::~HostileRig() {
    stopping_ = true;
    thread_.join();
}

double HostileRig::between(double lowest, double highest) {
    return std::uniform_real_distribution(lowest, highest)(random_);
}

void HostileRig::run() {
    std::vector<std::string> routes;
    while (!stopping_) {
        std::vector<zmq::message_t> parts;
        while (zmq::recv_multipart(socket_, std::back_inserter(parts), zmq::recv_flags::dontwait)) {
            const std::string route = parts.front().to_string();
            if (std::find(routes.begin(), routes.end(), route) == routes.end())
                routes.push_back(route);
            parts.clear();
        }
        std::this_thread::sleep_for(1ms);
        if (routes.empty()) continue;
        const Parts message = next_message();
        for (const std::string& route : routes) {
            std::vector<zmq::const_buffer> buffers{zmq::buffer(route)};
            for (const std::vector<std::byte>& part : message) buffers.push_back(zmq::buffer(part));
            try {
                sent_ += zmq::send_multipart(socket_, buffers, zmq::send_flags::dontwait) ? 1 : 0;
            } catch (const zmq::error_t&) {
                // The host is away.
            }
        }
    }
}

HostileRig::Parts HostileRig::next_message() {
    // Every second message is right, so that its frames are in frame sets while it attacks.
    const int kind = any(2) == 0 ? right : static_cast<int>(any(kinds));
    if (kind == largest_size && any(50) != 0) return next_message();
    const auto now = static_cast<std::uint64_t>(TaiClock::now().time_since_epoch() / period_);
    RigFrame frame = make_frame(now, small_width_px, small_height_px);
    frame.rig = name_;
    frame.session = session_;
    spoil(frame, kind);
    RigMessage message;
    message.rig = name_;
    message.session = session_;
    message.link = link_;
    message.rig_counters = {frames_, 0, 0, frames_, 0};
    message.sync = frame.sync;
    message.counters = {frames_ + 1, frames_ + 1, 0, 0};
    spoil(message, kind);
    Parts parts{encode(message)};
    if (kind == refusal) return parts;
    if (kind == unasked) {
        const std::size_t count = any(6);
        for (std::size_t i = 0; i < count; ++i) parts.emplace_back(any(5000));
        return parts;
    }
    try {
        PackedFrame packed = (any(2) == 0 ? lossless_ : jpeg_).encode(frame);
        if (kind == largest_size) packed.disparity = huge_;
        parts.push_back(std::move(packed.header));
        parts.push_back(std::move(packed.colour));
        parts.push_back(std::move(packed.disparity));
    } catch (const Error&) {
        return next_message();
    }
    if (kind == damaged) damage(parts);
    ++frames_;
    return parts;
}

void HostileRig::spoil(RigFrame& frame, int kind) {
    switch (kind) {
        case slightly_ahead:
            frame.trigger_index += 1 + any(20);
            break;
        case far_ahead:
            frame.trigger_index = max_trigger_index - any(1000);
            break;
        case long_past:
            frame.trigger_index -= any(std::min<std::uint64_t>(frame.trigger_index, 1'000'000));
            break;
        case other_size: {
            const auto side = [&] { return 1 + static_cast<int>(any(300)); };
            RigFrame other = make_frame(frame.trigger_index, side(), side());
            frame.geometry = other.geometry;
            frame.colour = other.colour;
            frame.disparity = other.disparity;
            break;
        }
        case largest_size:
            frame.geometry.width_px = frame.geometry.height_px = max_picture_side_px;
            frame.colour = ColourImage(max_picture_side_px, max_picture_side_px, {9, 9, 9, 255});
            frame.disparity = DisparityImage::zeros(max_picture_side_px, max_picture_side_px);
            break;
        case other_lens:
            frame.geometry.f_px = std::exp(between(std::log(1e-3), std::log(1e6)));
            frame.geometry.cx_left_px = between(-1e6, 1e6);
            frame.geometry.cx_right_px = between(-1e6, 1e6);
            frame.geometry.cy_px = between(-1e6, 1e6);
            frame.geometry.baseline_m = std::exp(between(std::log(1e-6), std::log(1e5)));
            break;
        case other_place: {
            const double far_m = any(2) == 0 ? 10 : 9e4;
            const auto place = [&] { return between(-far_m, far_m); };
            frame.world_from_camera = look_at({place(), place(), place()}, {0, 1, 0});
            frame.calibration_id = "calibration-" + std::to_string(any(1000));
            frame.place_is_assumed = any(2) == 0;
            break;
        }
        case other_time:
            frame.exposure = tai_from_ns(static_cast<std::int64_t>(random_() >> 1));
            break;
        case raw_pair:
            frame.content = RigFrame::Content::raw_pair;
            frame.right = frame.colour;
            frame.disparity = {};
            break;
        case without_pulse:
            frame.synchronized = false;
            break;
        case other_name:
            frame.rig = any(2) == 0 ? "near" : "nobody";
            break;
        case wild_depth:
            for (auto& disparity : frame.disparity)
                disparity = static_cast<std::uint16_t>(random_());
            frame.max_disparity_px = static_cast<float>(between(0, 2000));
            break;
        case impossible_sync:
            frame.sync.first_pulse = max_trigger_index - any(10);
            frame.sync.rate_hz = any(2) == 0 ? 1e6 : 0.001;
            frame.sync.tai_offset_s = static_cast<int>(any(2'000'000'000)) - 1'000'000'000;
            frame.sync.clock_steps = any(1000);
            frame.sync.clock_step_ms = between(-1e300, 1e300);
            frame.sync.ptp_offset_ns = between(-1e300, 1e300);
            frame.sync.clock_ppm = std::numeric_limits<double>::max();
            break;
        default:
            break;
    }
}

void HostileRig::spoil(RigMessage& message, int kind) {
    switch (kind) {
        case impossible_counts:
            message.counters = {random_(), any(2) == 0 ? random_() : any(frames_ + 1), random_(),
                                random_()};
            message.rig_counters = {random_(), random_(), random_(), random_(), random_()};
            // A count of frames sent that is not taken back would stand for all that follows.
            link_ = 1 + any(1000);
            frames_ = 0;
            break;
        case new_session:
            session_ = random_();
            link_ = random_() | 1;
            frames_ = 0;
            break;
        case refusal:
            message.refusal = "no " + std::string(any(500), 'o');
            message.refusal_passes = any(2) == 0;
            break;
        case unasked:
            message.report_id = random_();
            message.fetch = FetchState{1 + any(100), random_(), any(2) == 0, "trouble"};
            break;
        case twice:
            message.health.starting = std::string(any(120), 's');
            message.health.temperature_c = static_cast<float>(between(-1e30, 1e30));
            break;
        default:
            break;
    }
}

void HostileRig::damage(Parts& parts) {
    std::vector<std::byte>& part = parts[any(parts.size())];
    if (part.empty()) return;
    for (std::uint64_t i = 0; i <= any(8); ++i) {
        switch (any(3)) {
            case 0:
                part[any(part.size())] = std::byte(random_());
                break;
            case 1:
                part.resize(1 + any(part.size()));
                break;
            default:
                part.insert(part.end(), any(100), std::byte(random_()));
                break;
        }
    }
}

}  // namespace vantage
