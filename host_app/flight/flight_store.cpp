#include "host_app/flight/flight_store.h"

#include <algorithm>
#include <chrono>
#include <numbers>
#include <span>
#include <utility>

#include "common/base/atomic_file.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/output_path.h"

namespace vantage {
namespace {

constexpr std::size_t most_bytes = 1 << 20;
constexpr std::chrono::seconds patience{1};

/// Along an orbit, unless the camera was where no orbit is allowed, as a tracked one may be.
MovePath path_of(const FlightRecording& flight, const FlightLimits& limits) {
    const bool is_orbit = std::all_of(flight.begin(), flight.end(), [&](const FlightSample& each) {
        return is_same_shot(constrained(each.view, limits), each.view);
    });
    return is_orbit ? MovePath::orbit : MovePath::free;
}

SimplifiedFlight simplify_whole(const FlightRecording& flight, const FlightLimits& limits) {
    return simplified(flight, {}, limits, path_of(flight, limits));
}

}  // namespace

FlightStore::FlightStore(std::filesystem::path file) : file_(std::move(file)) {
    if (!std::filesystem::exists(file_)) return;
    book_ = load_flight(file_);
    bytes_ = read_file(file_, most_bytes);
}

FlightStore::~FlightStore() {
    if (simplified_.valid()) simplified_.wait();
}

void FlightStore::keep(const Helm::Change& change) {
    book_.shots = change.book.shots;
    book_.lowest_m = std::min(book_.lowest_m, change.book.lowest_m);
    if (change.is_of_move) {
        if (std::exchange(flies_another_, false)) is_file_move_ = !book_.move;
        book_.move = change.book.move;
    }
    if (!changed_) changed_ = MonotonicClock::now();
}

void FlightStore::simplify(FlightRecording flight, const FlightLimits& limits) {
    waiting_.emplace_back(std::move(flight), limits);
}

std::optional<Move> FlightStore::take_simplified(bool waits) {
    if (!simplified_.valid() && !waiting_.empty()) {
        simplified_ = std::async(std::launch::async, [next = std::move(waiting_.front())] {
            return simplify_whole(next.first, next.second);
        });
        waiting_.erase(waiting_.begin());
    }
    if (!simplified_.valid()) return std::nullopt;
    if (!waits && simplified_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    SimplifiedFlight flight = simplified_.get();
    const FlightTolerance tolerance;
    log_info(
        "the flight of {:.1f} s is a move of {} keyframes, nowhere further from it than {:.0f} mm "
        "and {:.2f} degrees",
        flight.move.duration_s(), flight.move.keyframes().size(),
        1000 * flight.worst * tolerance.shift_m,
        flight.worst * tolerance.turn_rad * 180 / std::numbers::pi);
    replace_move(flight.move);
    return std::move(flight.move);
}

void FlightStore::replace_move(std::optional<Move> move) {
    // What waits to be written is of the move that goes.
    if (changed_) write();
    is_file_move_ = !book_.move;
    flies_another_ = false;
    book_.lowest_m = std::min(book_.lowest_m, move->limits().min_eye_height_m);
    book_.move = std::move(move);
    changed_ = MonotonicClock::now();
}

std::optional<Move> FlightStore::follow(MonotonicTime now) {
    std::optional<Move> flight = take_simplified(false);
    if (changed_ && now - *changed_ >= patience) write();
    return flight;
}

void FlightStore::finish() {
    while (take_simplified(true))
        ;
    if (changed_) write();
}

void FlightStore::put_aside(const char* why) {
    const std::filesystem::path aside = free_path(file_);
    std::filesystem::rename(file_, aside);
    log_info("{} is {} now, since {}", file_.string(), aside.string(), why);
}

void FlightStore::write() {
    const std::string text = to_toml(book_);
    const auto fresh = std::as_bytes(std::span(text));
    try {
        if (std::filesystem::exists(file_)) {
            const bool is_ours = read_file(file_, most_bytes) == bytes_;
            if (!is_ours)
                put_aside("another program has changed it");
            else if (!is_file_move_)
                put_aside("another move takes its place");
        }
        write_file_atomically(file_, fresh);
        bytes_.assign(fresh.begin(), fresh.end());
        is_file_move_ = true;
        changed_.reset();
        has_failed_ = false;
    } catch (const std::exception& error) {
        if (!std::exchange(has_failed_, true))
            log_error("shots and move are not kept, and it is tried again: {}", error.what());
        changed_ = MonotonicClock::now();
    }
}

std::filesystem::path flight_file_of(std::filesystem::path file) {
    return file.replace_extension(".flight.toml");
}

}  // namespace vantage
