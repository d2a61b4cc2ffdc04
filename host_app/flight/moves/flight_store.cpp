#include "host_app/flight/moves/flight_store.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "common/base/log.h"

namespace vantage {
namespace {

/// An orbit, unless the camera left the flight limits, as a tracked camera may.
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

FlightStore::FlightStore(std::filesystem::path file) : file_(std::move(file), "shots and move") {
    if (file_.is_there()) book_ = load_flight(file_.path());
}

FlightStore::~FlightStore() {
    if (simplified_.valid()) simplified_.wait();
}

void FlightStore::keep(const FlightController::Change& change) {
    book_.shots = change.book.shots;
    book_.lowest_m = std::min(book_.lowest_m, change.book.lowest_m);
    if (change.is_of_move) {
        if (std::exchange(flies_another_, false)) is_file_move_ = !book_.move;
        book_.move = change.book.move;
    }
    file_.note_change();
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
        "the recorded flight of {:.1f} s became a move of {} keyframes, which deviates by at most "
        "{:.0f} mm and {:.2f} degrees",
        flight.move.duration_s(), flight.move.keyframes().size(),
        1000 * flight.worst * tolerance.shift_m,
        flight.worst * tolerance.turn_rad * 180 / std::numbers::pi);
    replace_move(flight.move);
    return std::move(flight.move);
}

void FlightStore::replace_move(std::optional<Move> move) {
    // Changes that are not written yet belong to the old move.
    if (file_.is_changed()) write();
    is_file_move_ = !book_.move;
    flies_another_ = false;
    book_.lowest_m = std::min(book_.lowest_m, move->limits().min_eye_height_m);
    book_.move = std::move(move);
    file_.note_change();
}

std::optional<Move> FlightStore::follow(MonotonicTime now) {
    std::optional<Move> flight = take_simplified(false);
    if (file_.is_due(now)) write();
    return flight;
}

void FlightStore::finish() {
    while (take_simplified(true))
        ;
    if (file_.is_changed()) write();
}

void FlightStore::write() {
    if (file_.write(to_toml(book_), is_file_move_ ? nullptr : "another move replaces it"))
        is_file_move_ = true;
}

std::filesystem::path flight_file_of(std::filesystem::path file) {
    return file.replace_extension(".flight.toml");
}

}  // namespace vantage
