#include "host_app/flight/moves/flight_store.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/config/toml_edit.h"
#include "common/config/toml_reader.h"
#include "host_app/flight/flight_plan.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {
namespace {

constexpr double rad_per_deg = std::numbers::pi / 180;
constexpr double max_time_s = 24 * 3600, max_shot_s = 60;
/// Limits of values in the file, wide enough for a stage of any size.
constexpr double min_distance_m = 0.02, max_distance_m = 1000, max_offset_m = 1000;
constexpr double min_floor_m = -1000, max_floor_m = 100;
/// Largest shift of a camera at a limit by rounding to nine digits.
constexpr double rounding_m = 1e-5;
/// Largest coordinate of an eye, and largest focus distance.
constexpr double max_eye_m = 100;
constexpr double max_angle_deg = 36000;

constexpr std::initializer_list<const char*> orbit_keys{"pivot_m", "azimuth_deg", "elevation_deg",
                                                        "distance_m"};
constexpr std::initializer_list<const char*> head_keys{"pan_deg", "tilt_deg", "focus_m"};

Easing easing_of(const std::string& name) {
    if (name == "linear") return Easing::linear;
    if (name == "ease") return Easing::ease;
    if (name == "cut") return Easing::cut;
    return Easing::smooth;
}

const char* name_of(Easing easing) {
    switch (easing) {
        case Easing::linear:
            return "linear";
        case Easing::ease:
            return "ease";
        case Easing::cut:
            return "cut";
        case Easing::smooth:
            break;
    }
    return "smooth";
}

void read_degrees(TomlTable& table, std::string_view key, double& value_rad, Range<double> range) {
    double degrees = 0;
    table.read(key, degrees, range);
    if (table.has(key)) value_rad = degrees * rad_per_deg;
}

bool has_any(const TomlTable& table, std::initializer_list<const char*> keys) {
    for (const char* key : keys)
        if (table.has(key)) return true;
    return false;
}

void refuse_all(const TomlTable& table, std::initializer_list<const char*> keys,
                const std::string& others) {
    for (const char* key : keys)
        if (table.has(key))
            table.refuse(key,
                         fmt::format("cannot be combined with {}: give a camera by its orbit, by "
                                     "eye_m and target_m, or by eye_m, pan_deg and tilt_deg",
                                     others));
}

/// Reads a camera that is given by its eye and its target.
void read_eye(TomlTable& table, const Eigen::Vector3d& eye, OrbitView& view) {
    Eigen::Vector3d target = view.pivot_m;
    table.read("target_m", std::span<double>(target.data(), 3), {-30, 30});
    if ((eye - target).norm() < 1e-6)
        table.refuse("eye_m", "must not be the same point as target_m");
    const double roll_rad = view.roll_rad;
    view = view_from_eye(eye, target, view.field_of_view_rad, view.azimuth_rad);
    view.roll_rad = roll_rad;
}

/// Reads a camera that is given by its eye, pan and tilt.
void read_head(TomlTable& table, const Eigen::Vector3d& eye, OrbitView& view) {
    PanTiltRoll turn{-view.azimuth_rad, -view.elevation_rad, view.roll_rad};
    read_degrees(table, "pan_deg", turn.pan_rad, {-max_angle_deg, max_angle_deg});
    read_degrees(table, "tilt_deg", turn.tilt_rad, {-90, 90});
    table.read("focus_m", view.distance_m, {0.05, max_eye_m});
    view.azimuth_rad = -turn.pan_rad;
    view.elevation_rad = -turn.tilt_rad;
    view.pivot_m = eye + view.distance_m * turned(turn).col(2);
}

/// Reads a camera into `view`, which holds the values of the keyframe before. True if it is given
/// by pan and tilt.
bool read_camera(TomlTable& table, OrbitView& view, const FlightLimits& limits) {
    read_degrees(table, "field_of_view_deg", view.field_of_view_rad, {5, 110});
    read_degrees(table, "roll_deg", view.roll_rad, {-max_angle_deg, max_angle_deg});
    Eigen::Vector3d eye = view.eye_m();
    table.read("eye_m", std::span<double>(eye.data(), 3), {-max_eye_m, max_eye_m});
    if (has_any(table, head_keys)) {
        refuse_all(table, {"target_m"}, "pan_deg and tilt_deg");
        refuse_all(table, orbit_keys, "pan_deg and tilt_deg");
        read_head(table, eye, view);
        return true;
    }
    if (has_any(table, {"eye_m", "target_m"})) {
        refuse_all(table, orbit_keys, "eye_m and target_m");
        table.require("eye_m");
        if (table.has("eye_m")) read_eye(table, eye, view);
        return false;
    }
    table.read("pivot_m", std::span<double>(view.pivot_m.data(), 3),
               {-limits.max_pivot_offset_m, limits.max_pivot_offset_m});
    read_degrees(table, "azimuth_deg", view.azimuth_rad, {-max_angle_deg, max_angle_deg});
    read_degrees(table, "elevation_deg", view.elevation_rad, {-86, 86});
    table.read("distance_m", view.distance_m, {limits.min_distance_m, limits.max_distance_m});
    return false;
}

/// Refuses a camera outside the limits, at the key `key`.
void check_camera(const TomlTable& table, const char* key, OrbitView& view,
                  const FlightLimits& limits, bool is_orbit) {
    const Eigen::Vector3d eye = view.eye_m();
    if (!is_orbit) {
        if (eye.y() < limits.min_eye_height_m - rounding_m)
            table.refuse(key,
                         fmt::format("belongs to a camera at a height of {:.2f} m; the minimum "
                                     "is {} m (lowest_m)",
                                     eye.y(), limits.min_eye_height_m));
        return;
    }
    const OrbitView allowed = constrained(view, limits);
    if ((allowed.eye_m() - eye).norm() > rounding_m ||
        (allowed.pivot_m - view.pivot_m).norm() > rounding_m)
        table.refuse(
            key, fmt::format("belongs to a camera at ({:.2f}, {:.2f}, {:.2f}) m, {:.2f} m from "
                             "its pivot, which is outside the flight's limits: at least {} m "
                             "above the floor (lowest_m), {} to {} m from the pivot, at "
                             "most {:.0f} degrees up or down",
                             eye.x(), eye.y(), eye.z(), view.distance_m, limits.min_eye_height_m,
                             limits.min_distance_m, limits.max_distance_m,
                             limits.max_elevation_rad / rad_per_deg));
    view = allowed;
}

MoveKeyframe read_keyframe(TomlTable& table, const std::vector<MoveKeyframe>& before,
                           const FlightLimits& limits, MovePath path) {
    MoveKeyframe keyframe;
    table.read("time_s", keyframe.time_s, {0, max_time_s});
    table.require("time_s");
    if (!before.empty()) keyframe.view = before.back().view;
    const bool is_head = read_camera(table, keyframe.view, limits);
    check_camera(table, "time_s", keyframe.view, limits, path == MovePath::orbit || !is_head);
    std::string easing = "smooth";
    table.read_choice("easing", easing, {"smooth", "linear", "ease", "cut"});
    keyframe.easing = easing_of(easing);
    double take_s = 0;
    table.read("take_s", take_s, {0, 1e7});
    if (table.has("take_s")) keyframe.take_s = take_s;
    if (!before.empty() && keyframe.take_s.has_value() != before.front().take_s.has_value())
        table.refuse(keyframe.take_s ? "take_s" : "time_s",
                     "belongs to a keyframe that differs from the first one: give take_s in all "
                     "keyframes or in none");
    if (before.empty() && keyframe.time_s != 0)
        table.refuse("time_s", "must be 0 in the first keyframe");
    if (!before.empty() && keyframe.time_s <= before.back().time_s)
        table.refuse("time_s",
                     fmt::format("is {}, and it must be later than that of the keyframe before, {}",
                                 keyframe.time_s, before.back().time_s));
    return keyframe;
}

void read_shot(TomlTable& table, FlightBook& book, const FlightLimits& limits) {
    int number = 0;
    table.require("number");
    table.read("number", number, {1, static_cast<int>(most_shots)});
    if (number == 0) return;
    std::optional<Shot>& place = book.shots[static_cast<std::size_t>(number - 1)];
    if (place)
        table.refuse(
            "number",
            fmt::format("is {} for the second time; give every shot its own number", number));
    Shot shot;
    table.read("name", shot.name);
    if (const std::string fault = fault_of_name(shot.name); !fault.empty())
        table.refuse("name", fault);
    if (shot.name.empty()) shot.name = fmt::format("shot {}", number);
    table.read("duration_s", shot.duration_s, {0, max_shot_s});
    std::string easing = name_of(shot.easing);
    table.read_choice("easing", easing, {"ease", "linear"});
    shot.easing = easing_of(easing);
    const bool is_head = read_camera(table, shot.view, limits);
    check_camera(table, "number", shot.view, limits, !is_head);
    place = std::move(shot);
}

/// Nine significant digits, without trailing zeros.
std::string number_text(double value) { return fmt::format("{:.9g}", value == 0 ? 0 : value); }

std::string camera_text(const OrbitView& view, bool is_head) {
    const auto degrees = [](double rad) { return number_text(rad / rad_per_deg); };
    const auto point = [](const Eigen::Vector3d& at) {
        return fmt::format("[{}, {}, {}]", number_text(at.x()), number_text(at.y()),
                           number_text(at.z()));
    };
    std::string text;
    if (is_head) {
        text = fmt::format("eye_m = {}\npan_deg = {}\ntilt_deg = {}\nfocus_m = {}\n",
                           point(view.eye_m()), degrees(-view.azimuth_rad),
                           degrees(-view.elevation_rad), number_text(view.distance_m));
    } else {
        text = fmt::format("pivot_m = {}\nazimuth_deg = {}\nelevation_deg = {}\ndistance_m = {}\n",
                           point(view.pivot_m), degrees(view.azimuth_rad),
                           degrees(view.elevation_rad), number_text(view.distance_m));
    }
    return text + fmt::format("roll_deg = {}\nfield_of_view_deg = {}\n", degrees(view.roll_rad),
                              degrees(view.field_of_view_rad));
}

}  // namespace

FlightBook load_flight(const std::filesystem::path& path) {
    FlightLimits limits;
    limits.min_distance_m = min_distance_m;
    limits.max_distance_m = max_distance_m;
    limits.max_pivot_offset_m = max_offset_m;
    FlightBook book;
    read_toml_file(path, 1, [&](TomlTable& top) {
        top.read("lowest_m", limits.min_eye_height_m, {min_floor_m, max_floor_m});
        std::vector<MoveKeyframe> keyframes;
        bool loop = false;
        std::string way = "orbit";
        top.read("loop", loop);
        top.read_choice("path", way, {"orbit", "free"});
        const MovePath move_path = way == "free" ? MovePath::free : MovePath::orbit;
        top.read_tables("keyframe", [&](TomlTable& table) {
            keyframes.push_back(read_keyframe(table, keyframes, limits, move_path));
        });
        top.read_tables("shot", [&](TomlTable& table) { read_shot(table, book, limits); });
        if (keyframes.size() > most_keyframes)
            top.refuse("keyframe",
                       fmt::format("occurs {} times, and a move has at most {} keyframes",
                                   keyframes.size(), most_keyframes));
        if (loop &&
            (keyframes.size() < 2 || !is_same_shot(keyframes.front().view, keyframes.back().view)))
            top.refuse("loop",
                       "is true, so the last keyframe must have the same view as the first "
                       "(its azimuth may differ by whole turns)");
        book.lowest_m = limits.min_eye_height_m;
        if (!keyframes.empty()) book.move.emplace(std::move(keyframes), loop, limits, move_path);
    });
    return book;
}

Move Move::load(const std::filesystem::path& path) {
    FlightBook book = load_flight(path);
    if (!book.move) fail("{} contains no move; add a [[keyframe]] with time_s = 0", path.string());
    return *std::move(book.move);
}

std::string to_toml(const FlightBook& book) {
    std::string text =
        "# A flight of Vantage's virtual camera; hw_config/moves/demo.toml (installed:\n"
        "# /usr/share/doc/vantage/examples/moves/demo.toml) explains the keys.\nversion = 1\n";
    if (book.lowest_m != FlightLimits().min_eye_height_m)
        text += fmt::format("lowest_m = {}\n", number_text(book.lowest_m));
    if (book.move) {
        const bool is_free = book.move->path() == MovePath::free;
        text += fmt::format("loop = {}\npath = \"{}\"\n", book.move->loops(),
                            is_free ? "free" : "orbit");
        for (const MoveKeyframe& keyframe : book.move->keyframes()) {
            text += fmt::format("\n[[keyframe]]\ntime_s = {}\n", number_text(keyframe.time_s));
            if (keyframe.take_s)
                text += fmt::format("take_s = {}\n", number_text(*keyframe.take_s));
            text += camera_text(keyframe.view, is_free);
            text += fmt::format("easing = \"{}\"\n", name_of(keyframe.easing));
        }
    }
    for (std::size_t i = 0; i < book.shots.size(); ++i)
        if (const std::optional<Shot>& shot = book.shots[i])
            text += fmt::format(
                "\n[[shot]]\nnumber = {}\nname = {}\nduration_s = {}\neasing = \"{}\"\n{}", i + 1,
                toml_string(shot->name), number_text(shot->duration_s), name_of(shot->easing),
                camera_text(shot->view, false));
    return text;
}

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
