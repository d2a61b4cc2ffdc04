#include "host_app/desk/windows/operator_window.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numbers>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "common/base/error.h"
#include "common/base/library_log.h"
#include "common/base/log.h"
#include "common/gl/context/limits.h"
#include "host_app/control/table/control_command.h"
#include "host_app/desk/windows/gl_window.h"

namespace vantage {
namespace {

/// Pause after drawing the desk, in times of the drawing: it takes at most a twentieth of the time,
/// and a third during operator input.
constexpr int idle_times = 19, idle_times_in_hand = 2;
/// Limits of the desk's period: faster changes could not be read, slower ones look frozen.
constexpr std::chrono::milliseconds min_desk_period{40}, max_desk_period{1000};
/// Longest time between the presses of a double click.
constexpr double double_press_s = 0.35;

/// Returns GLFW's code of a key by its name in the table of commands; a single character is its own
/// code.
int glfw_key(std::string_view name) {
    if (name == "Space") return GLFW_KEY_SPACE;
    constexpr std::pair<std::string_view, int> named[] = {
        {"Home", GLFW_KEY_HOME},          {"End", GLFW_KEY_END},      {"Insert", GLFW_KEY_INSERT},
        {"Delete", GLFW_KEY_DELETE},      {"PgUp", GLFW_KEY_PAGE_UP}, {"PgDn", GLFW_KEY_PAGE_DOWN},
        {"Backspace", GLFW_KEY_BACKSPACE}};
    for (const auto& [known, key] : named)
        if (name == known) return key;
    if (name.size() > 1) return GLFW_KEY_F1 + std::atoi(name.data() + 1) - 1;
    return name.empty() ? GLFW_KEY_UNKNOWN : name.front();
}

/// Returns the punctuation keys that commands and the window itself use.
std::string signs_of_commands() {
    std::string signs = "-=";
    for (const ControlCommand& command : control_commands()) {
        const std::string_view name = command.key.name;
        if (name.size() == 1 && !std::isalnum(static_cast<unsigned char>(name.front())))
            signs += name;
    }
    return signs;
}

/// Returns the label of a key in the current keyboard layout; empty if it has none.
std::string label_of_key(int key) {
    const char* label = glfwGetKeyName(key, 0);
    return label ? label : "";
}

/// Returns the command's argument if the key gives the command (1 for a command without one), or 0.
int number_of_key(const ControlCommand& command, int key, bool with_control) {
    const int first = glfw_key(command.key.name);
    const int keys = command.argument == CommandArgument::number ? command.max_number : 1;
    if (first == GLFW_KEY_UNKNOWN || key < first || key >= first + keys) return 0;
    // Ctrl matters only if two commands share the key.
    const bool shares_key = std::any_of(
        control_commands().begin(), control_commands().end(), [&](const ControlCommand& other) {
            return &other != &command && std::string_view(other.key.name) == command.key.name;
        });
    return shares_key && command.key.with_control != with_control ? 0 : key - first + 1;
}

}  // namespace

GlfwLibrary::GlfwLibrary() {
    glfwSetErrorCallback([](int, const char* message) {
        static LibraryLog log("GLFW", LogLevel::debug);
        log.note(message ? message : "");
    });
    if (!glfwInit())
        fail("cannot open a window ({}); use --headless to write the flight to files",
             glfw_reason());
}

GlfwLibrary::~GlfwLibrary() { glfwTerminate(); }

void OperatorWindow::WindowDeleter::operator()(GLFWwindow* window) const {
    glfwDestroyWindow(window);
}

OperatorWindow::OperatorWindow(const std::string& title, int width_px, int height_px)
    : caps_(label_of_key, signs_of_commands()) {
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
        int x = 0, y = 0, free_width = 0, free_height = 0;
        glfwGetMonitorWorkarea(monitor, &x, &y, &free_width, &free_height);
        if (free_width > 0 && free_height > 0) {
            width_px = std::min(width_px, free_width);
            height_px = std::min(height_px, free_height);
        }
    }
    hint_gl_window();
    window_.reset(create_gl_window(width_px, height_px, title, nullptr, nullptr));
    if (!window_)
        fail(
            "cannot open a window with OpenGL ES 3.1 ({}); use --headless to write the flight to "
            "files",
            glfw_reason());
    glfwSetWindowSizeLimits(window_.get(), 320, 240, PiLimits::max_image_side_px,
                            PiLimits::max_image_side_px);
    glfwMakeContextCurrent(window_.get());
    // The programme's clock sets the pace; waiting for the screen too would miss its ticks.
    glfwSwapInterval(0);
    GlInfo::query().require_vantage_minimum();
    glfwSetWindowUserPointer(window_.get(), this);
    // Callbacks deliver every event: a whole drag may happen between two polls.
    glfwSetKeyCallback(window_.get(), on_key);
    glfwSetCharCallback(window_.get(), on_letter);
    glfwSetMouseButtonCallback(window_.get(), on_button);
    glfwSetCursorPosCallback(window_.get(), on_cursor);
    glfwSetScrollCallback(window_.get(), on_scroll);
    glfwSetWindowRefreshCallback(window_.get(), on_change);
    glfwGetWindowPos(window_.get(), &place_.x, &place_.y);
    glfwGetWindowSize(window_.get(), &place_.width, &place_.height);
    glfwSetWindowPosCallback(window_.get(), on_moved);
    glfwSetWindowSizeCallback(window_.get(), on_sized);
    glfwSetWindowMaximizeCallback(window_.get(), on_maximised);
    ui_.emplace(letter_height_px(static_cast<float>(width_px), static_cast<float>(height_px), 1));
    renderer_.emplace(shaders_);
    if (const std::string caps = caps_.words(); !caps.empty())
        log_info("keys go by what is on their caps; on this keyboard {}", caps);
}

OperatorWindow::~OperatorWindow() = default;

OperatorWindow& OperatorWindow::of(GLFWwindow* window) {
    return *static_cast<OperatorWindow*>(glfwGetWindowUserPointer(window));
}

bool OperatorWindow::closed() const { return glfwWindowShouldClose(window_.get()) != 0; }

bool OperatorWindow::held_cap(int letter) const {
    const int key = caps_.place_of(letter);
    return key > 0 && held(key);
}

bool OperatorWindow::held(int key) const { return glfwGetKey(window_.get(), key) == GLFW_PRESS; }

void OperatorWindow::on_change(GLFWwindow* window) { of(window).is_changed_ = true; }

void OperatorWindow::on_moved(GLFWwindow* window, int x, int y) {
    WindowPlace& place = of(window).place_;
    if (place.is_maximised) return;
    place.x = x;
    place.y = y;
}

void OperatorWindow::on_sized(GLFWwindow* window, int width, int height) {
    WindowPlace& place = of(window).place_;
    // A minimised window has no size.
    if (place.is_maximised || width < 1 || height < 1) return;
    place.width = width;
    place.height = height;
}

void OperatorWindow::on_maximised(GLFWwindow* window, int is_maximised) {
    of(window).place_.is_maximised = is_maximised != 0;
}

void OperatorWindow::arrange(const DeskArrangement& desk) {
    const int help = switches_.help;
    switches_ = desk.switches;
    switches_.help = help;
    is_changed_ = true;
    rigs_place_ = desk.rigs_window;
    if (!desk.window) return;
    put_window(window_.get(), *desk.window);
}

void OperatorWindow::on_key(GLFWwindow* window, int key, int, int action, int modifiers) {
    OperatorWindow& self = of(window);
    if (action == GLFW_RELEASE) return;
    self.is_changed_ = true;
    key = self.caps_.meant_by(key);
    if (self.prompt_.is_open()) return self.type(key);
    const bool with_control = (modifiers & GLFW_MOD_CONTROL) != 0;
    if (self.panel_.is_open()) return self.press_in_panel(key, with_control);
    for (const ControlCommand& command : control_commands()) {
        const int number = number_of_key(command, key, with_control);
        if (number == 0 || (action != GLFW_PRESS && !command.key.repeats)) continue;
        const std::string question = self.question_of(command, number);
        if (question.empty() || self.guard_.confirms(question, glfwGetTime()))
            apply({&command, static_cast<double>(number)}, self.input_);
    }
    if (action == GLFW_PRESS) self.take_key(key, modifiers);
}

void OperatorWindow::on_letter(GLFWwindow* window, unsigned codepoint) {
    OperatorWindow& self = of(window);
    if (self.prompt_.is_open())
        self.prompt_.type(codepoint);
    else
        self.panel_.type(codepoint);
}

void OperatorWindow::type(int key) {
    switch (key) {
        case GLFW_KEY_ESCAPE:
            return prompt_.close();
        case GLFW_KEY_BACKSPACE:
            return prompt_.erase();
        case GLFW_KEY_TAB:
            return prompt_.complete();
        case GLFW_KEY_ENTER:
        case GLFW_KEY_KP_ENTER:
            if (const std::optional<CommandCall> call = prompt_.call()) {
                const std::string question =
                    question_of(*call->command, static_cast<int>(call->argument));
                if (!question.empty() && !guard_.confirms(question, glfwGetTime())) return;
                apply(*call, input_);
                prompt_.close();
            }
            return;
        default:
            return;
    }
}

void OperatorWindow::press_in_panel(int key, bool with_control) {
    using Key = WheelPanel::Key;
    constexpr std::pair<int, Key> keys[] = {{GLFW_KEY_UP, Key::up},
                                            {GLFW_KEY_DOWN, Key::down},
                                            {GLFW_KEY_LEFT, Key::left},
                                            {GLFW_KEY_RIGHT, Key::right},
                                            {GLFW_KEY_TAB, Key::tab},
                                            {GLFW_KEY_ENTER, Key::enter},
                                            {GLFW_KEY_KP_ENTER, Key::enter},
                                            {GLFW_KEY_ESCAPE, Key::escape},
                                            {GLFW_KEY_BACKSPACE, Key::backspace}};
    std::optional<WheelCall> call;
    for (const auto& [known, meant] : keys)
        if (key == known) call = panel_.press(meant);
    if (with_control && key == GLFW_KEY_S) call = WheelCall{WheelCall::Action::save};
    if (with_control && key == GLFW_KEY_M) call = WheelCall{WheelCall::Action::close};
    if (call) wheel_calls_.push_back(*call);
}

std::string OperatorWindow::question_of(const ControlCommand& command, int number) const {
    const std::string_view name = command.name;
    if (name == "take" && take_runs_) return "Press T again to end the take";
    if (name == "remove_keyframe") return "Press X again to remove the keyframe";
    if (name == "learn_background") return "Press Ctrl + J again to learn the background anew";
    if (name == "store" && number <= shot_places &&
        kept_shots_[static_cast<std::size_t>(number - 1)])
        return fmt::format("Press Ctrl + {} again to replace shot {}", number, number);
    return "";
}

/// Handles the window's own keys.
void OperatorWindow::take_key(int key, int modifiers) {
    switch (key) {
        case GLFW_KEY_F1:
            if ((modifiers & GLFW_MOD_CONTROL) != 0) {
                switches_.figures ^= true;
                break;
            }
            switches_.help = switches_.help == 0                  ? 1
                             : switches_.help < drawn_.help_pages ? switches_.help + 1
                                                                  : 0;
            break;
        case GLFW_KEY_ENTER:
        case GLFW_KEY_KP_ENTER:
            prompt_.open();
            break;
        case GLFW_KEY_TAB:
            take_tab((modifiers & GLFW_MOD_SHIFT) != 0, (modifiers & GLFW_MOD_CONTROL) != 0);
            break;
        case GLFW_KEY_ESCAPE:
            if (guard_.confirms(has_unsaved_wheel_
                                    ? "The wheel's map is not saved (Ctrl + M, then Ctrl + S); "
                                      "press Esc again to quit without it"
                                    : "Press Esc again to quit",
                                glfwGetTime()))
                glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
            break;
        default:
            break;
    }
}

void OperatorWindow::take_tab(bool with_shift, bool with_control) {
    if (with_shift && with_control)
        switches_.rigs_apart ^= true;
    else if (with_control)
        switches_.outside ^= true;
    else if (with_shift)
        switches_.rigs ^= true;
    else
        switches_.panels ^= true;
}

void OperatorWindow::on_button(GLFWwindow* window, int button, int action, int) {
    OperatorWindow& self = of(window);
    if (button < 0 || button >= static_cast<int>(self.drags_.size())) return;
    // A drag moves the camera only if it began on the picture.
    self.drags_[static_cast<std::size_t>(button)] =
        action == GLFW_PRESS && !self.panel_.is_open() &&
        self.drawn_.in_hand().contains(static_cast<float>(self.cursor_x_),
                                       static_cast<float>(self.cursor_y_));
    if (button != GLFW_MOUSE_BUTTON_LEFT) return;
    self.drags_time_ = self.drags_outside_ = false;
    if (action == GLFW_PRESS) self.press_at_cursor();
}

void OperatorWindow::press_at_cursor() {
    const auto is_on = [&](const DeskRect& rect) {
        return rect.contains(static_cast<float>(cursor_x_), static_cast<float>(cursor_y_));
    };
    is_changed_ = true;
    if (panel_.is_open()) {
        for (const DeskSpots::Numbered& control : drawn_.spots.wheel_controls)
            if (is_on(control.rect)) wheel_calls_.push_back(panel_.press_control(control.number));
        return;
    }
    for (const DeskSpots::Numbered& shot : drawn_.spots.shots)
        if (is_on(shot.rect)) input_.commands.push_back(command::RecallShot{shot.number});
    for (const DeskSpots::Numbered& output : drawn_.spots.outputs)
        if (is_on(output.rect)) input_.commands.push_back(command::ToggleOutput{output.number});
    for (const DeskSpots::Numbered& clip : drawn_.spots.clips)
        if (is_on(clip.rect))
            input_.commands.push_back(ReplayCall{ReplayAction::hold_clip, clip.number});
    for (const DeskSpots::Numbered& entry : drawn_.spots.entries)
        if (is_on(entry.rect))
            input_.commands.push_back(ReplayCall{ReplayAction::select_entry, entry.number});
    if (is_on(drawn_.spots.live)) input_.commands.push_back(command::ToLive{});
    if (is_on(drawn_.in_hand())) press_on_picture();
    drags_outside_ = is_on(drawn_.spots.outside);
    if (!drawn_.spots.time || !is_on(drawn_.spots.time->rect)) return;
    drags_time_ = true;
    seek_at_cursor();
}

void OperatorWindow::seek_at_cursor() {
    if (!drawn_.spots.time) return;
    const auto& [rect, time] = *drawn_.spots.time;
    seek_ = time.pulse_at((cursor_x_ - rect.left) / rect.width);
    is_changed_ = true;
}

/// Picks a place in the picture by a double click.
void OperatorWindow::press_on_picture() {
    const double now_s = glfwGetTime();
    const bool is_second = pressed_s_ >= 0 && now_s - pressed_s_ < double_press_s;
    pressed_s_ = is_second ? -1 : now_s;
    if (!is_second) return;
    const DeskRect& picture = drawn_.in_hand();
    input_.commands.push_back(command::PickPivot{
        {(cursor_x_ - picture.left) / picture.width, (cursor_y_ - picture.top) / picture.height}});
}

void OperatorWindow::on_cursor(GLFWwindow* window, double x, double y) {
    int width = 0, height = 0, width_px = 0, height_px = 0;
    glfwGetWindowSize(window, &width, &height);
    glfwGetFramebufferSize(window, &width_px, &height_px);
    if (width > 0 && height > 0)
        of(window).take_cursor(x * width_px / width, y * height_px / height);
}

void OperatorWindow::take_cursor(double x, double y) {
    const double width = std::max(drawn_.in_hand().width, 1.0f);
    const double right = (x - cursor_x_) / width, down = (y - cursor_y_) / width;
    cursor_x_ = x;
    cursor_y_ = y;
    if (drags_time_) seek_at_cursor();
    if (drags_outside_) {
        const double across = std::max(drawn_.spots.outside.width, 1.0f) / width;
        switches_.eye.turn(-right / across * std::numbers::pi, down / across * std::numbers::pi);
        is_changed_ = true;
    }
    if (drags_[GLFW_MOUSE_BUTTON_LEFT]) {
        // A drag across the whole picture is half a turn; the stage follows the mouse.
        input_.orbit_azimuth_rad -= right * std::numbers::pi;
        input_.orbit_elevation_rad += down * std::numbers::pi;
    }
    if (drags_[GLFW_MOUSE_BUTTON_RIGHT] || drags_[GLFW_MOUSE_BUTTON_MIDDLE]) {
        input_.pan_right_widths -= right;
        input_.pan_up_widths += down;
    }
}

void OperatorWindow::on_scroll(GLFWwindow* window, double, double up) {
    OperatorWindow& self = of(window);
    if (self.panel_.is_open()) return;
    const auto is_on = [&](const DeskRect& rect) {
        return rect.contains(static_cast<float>(self.cursor_x_),
                             static_cast<float>(self.cursor_y_));
    };
    constexpr double per_notch = 0.12;
    const bool with_control = self.held(GLFW_KEY_LEFT_CONTROL) || self.held(GLFW_KEY_RIGHT_CONTROL);
    if (is_on(self.drawn_.in_hand()))
        (with_control ? self.input_.zoom : self.input_.dolly) += per_notch * up;
    else if (is_on(self.drawn_.spots.outside))
        self.switches_.eye.go_nearer(per_notch * up), self.is_changed_ = true;
    else if (self.drawn_.spots.time && is_on(self.drawn_.spots.time->rect))
        self.input_.commands.push_back(command::StepFrames{up});
}

void OperatorWindow::take_held_keys(double dt_s) {
    constexpr double turn_rad_s = 0.9, pan_widths_s = 0.35, dolly_s = 0.8, zoom_s = 0.6;
    const auto axis = [&](int less, int more) { return held(more) - held(less); };
    const auto caps_axis = [&](int less, int more) { return held_cap(more) - held_cap(less); };
    const int nearer =
        caps_axis(GLFW_KEY_MINUS, GLFW_KEY_EQUAL) + axis(GLFW_KEY_KP_SUBTRACT, GLFW_KEY_KP_ADD);
    if (shows_outside() && (held(GLFW_KEY_LEFT_CONTROL) || held(GLFW_KEY_RIGHT_CONTROL))) {
        const int right = axis(GLFW_KEY_LEFT, GLFW_KEY_RIGHT);
        const int up = axis(GLFW_KEY_DOWN, GLFW_KEY_UP);
        switches_.eye.turn(dt_s * turn_rad_s * right, dt_s * turn_rad_s * up);
        switches_.eye.go_nearer(dt_s * zoom_s * nearer);
        is_changed_ |= right != 0 || up != 0 || nearer != 0;
        return;
    }
    input_.orbit_azimuth_rad += dt_s * turn_rad_s * axis(GLFW_KEY_LEFT, GLFW_KEY_RIGHT);
    input_.orbit_elevation_rad += dt_s * turn_rad_s * axis(GLFW_KEY_DOWN, GLFW_KEY_UP);
    input_.pan_right_widths += dt_s * pan_widths_s * caps_axis(GLFW_KEY_A, GLFW_KEY_D);
    input_.pan_up_widths += dt_s * pan_widths_s * caps_axis(GLFW_KEY_Q, GLFW_KEY_E);
    input_.dolly += dt_s * dolly_s * caps_axis(GLFW_KEY_S, GLFW_KEY_W);
    input_.zoom += dt_s * zoom_s * nearer;
}

FlightInput OperatorWindow::poll(double dt_s) {
    input_ = {};
    glfwPollEvents();
    if (!prompt_.is_open() && !panel_.is_open()) take_held_keys(dt_s);
    return input_;
}

std::optional<double> OperatorWindow::take_seek() { return std::exchange(seek_, std::nullopt); }

std::vector<WheelCall> OperatorWindow::take_wheel_calls() {
    return std::exchange(wheel_calls_, {});
}

bool OperatorWindow::is_desk_due(MonotonicTime now) const {
    return now >= (is_changed_ ? next_desk_in_hand_ : next_desk_);
}

void OperatorWindow::show(DeskState state) {
    const MonotonicTime start = MonotonicClock::now();
    is_changed_ = false;
    if (!fit_screen(window_.get(), *ui_, *renderer_, screen_)) return;
    if (state.question.empty()) state.question = guard_.question(glfwGetTime());
    if (prompt_.is_open()) state.typed = prompt_.line();
    panel_.follow(state.wheel_map);
    has_unsaved_wheel_ = state.has_unsaved_wheel;
    take_runs_ = state.take && state.take->is_running;
    for (std::size_t i = 0; i < kept_shots_.size(); ++i)
        kept_shots_[i] = i < state.shots.size() && state.shots[i].is_kept;
    ImGui::NewFrame();
    drawn_ = draw_desk(state, switches_, ui_->fonts());
    ImGui::Render();
    renderer_->draw(*ImGui::GetDrawData(), screen_->target);
    screen_->present(window_.get());
    show_rigs(state);
    const MonotonicTime end = MonotonicClock::now();
    next_desk_ = end + std::clamp<std::chrono::nanoseconds>(idle_times * (end - start),
                                                            min_desk_period, max_desk_period);
    next_desk_in_hand_ = std::min(next_desk_, end + idle_times_in_hand * (end - start));
    // An open wheel map shows the wheel's motion without delay.
    if (panel_.is_open()) next_desk_ = next_desk_in_hand_;
}

void OperatorWindow::show_pictures(const Texture& programme, const Texture* preview) {
    if (!screen_ || drawn_.picture.is_empty() || drawn_.has_overlay) return;
    renderer_->draw_picture(programme, drawn_.picture, screen_->target);
    if (preview && drawn_.preview)
        renderer_->draw_picture(*preview, *drawn_.preview, screen_->target);
    screen_->present(window_.get());
}

/// Shows the rigs in their own window if that is switched on. Closing the window switches it off.
void OperatorWindow::show_rigs(const DeskState& state) {
    if (rigs_window_ && rigs_window_->closed()) switches_.rigs_apart = false;
    if (!switches_.rigs_apart) return rigs_window_.reset();
    if (!rigs_window_) {
        try {
            rigs_window_ = std::make_unique<RigsWindow>(window_.get(), shaders_, rigs_place_);
        } catch (const Error& error) {
            log_warning("{}", error.what());
            switches_.rigs_apart = false;
            return;
        }
        rigs_window_->give_keys(this, on_key, on_letter);
    }
    rigs_window_->show(state);
    rigs_place_ = rigs_window_->place();
}

ColourImage OperatorWindow::screenshot() const {
    return screen_ ? ColourImage(screen_->texture.download()) : ColourImage();
}

}  // namespace vantage
