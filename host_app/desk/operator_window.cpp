#include "host_app/desk/operator_window.h"

#include <algorithm>
#include <cstdlib>
#include <numbers>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include "common/base/error.h"
#include "common/gl/limits.h"
#include "host_app/control/table/control_command.h"

namespace vantage {
namespace {

/// GLFW's reason for what just failed.
std::string glfw_reason() {
    const char* words = nullptr;
    if (glfwGetError(&words) == GLFW_NO_ERROR || !words) return "no reason given";
    std::string reason = words;
    while (!reason.empty() && (reason.back() == '.' || reason.back() == '\n')) reason.pop_back();
    return reason;
}

constexpr double end_asks_s = 3;
/// Between the presses of a double click.
constexpr double double_press_s = 0.35;

/// GLFW's number of a key by its name in the table of commands; letters and signs are their ASCII.
int glfw_key(std::string_view name) {
    if (name == "Space") return GLFW_KEY_SPACE;
    if (name == "Home") return GLFW_KEY_HOME;
    if (name.size() > 1) return GLFW_KEY_F1 + std::atoi(name.data() + 1) - 1;
    return name.empty() ? GLFW_KEY_UNKNOWN : name.front();
}

/// 0: the key does not give the command; else the number that it gives, 1 for one without.
int number_of_key(const ControlCommand& command, int key, bool with_control) {
    const int first = glfw_key(command.key.name);
    const int keys = command.argument == CommandArgument::number ? command.most : 1;
    if (first == GLFW_KEY_UNKNOWN || key < first || key >= first + keys) return 0;
    // Only where there are two of one key does it matter whether Ctrl is held.
    const bool shares_key = std::any_of(
        control_commands().begin(), control_commands().end(), [&](const ControlCommand& other) {
            return &other != &command && std::string_view(other.key.name) == command.key.name;
        });
    return shares_key && command.key.with_control != with_control ? 0 : key - first + 1;
}

/// 18 px for 1080 rows.
float body_font_px(int window_height_px) {
    return std::clamp(static_cast<float>(window_height_px) / 60.0f, 13.0f, 36.0f);
}

}  // namespace

GlfwLibrary::GlfwLibrary() {
    if (!glfwInit())
        fail("no window can be opened ({}); with --headless the flight goes to files",
             glfw_reason());
}

GlfwLibrary::~GlfwLibrary() { glfwTerminate(); }

void OperatorWindow::WindowDeleter::operator()(GLFWwindow* window) const {
    glfwDestroyWindow(window);
}

OperatorWindow::OperatorWindow(const std::string& title, int width_px, int height_px) {
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) {
        int x = 0, y = 0, free_width = 0, free_height = 0;
        glfwGetMonitorWorkarea(monitor, &x, &y, &free_width, &free_height);
        if (free_width > 0 && free_height > 0) {
            width_px = std::min(width_px, free_width);
            height_px = std::min(height_px, free_height);
        }
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_ES_API);
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 1);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    window_.reset(glfwCreateWindow(width_px, height_px, title.c_str(), nullptr, nullptr));
    if (!window_)
        fail(
            "no window with OpenGL ES 3.1 can be opened ({}); with --headless the flight goes to "
            "files",
            glfw_reason());
    glfwSetWindowSizeLimits(window_.get(), 320, 240, PiLimits::max_image_side_px,
                            PiLimits::max_image_side_px);
    glfwMakeContextCurrent(window_.get());
    // The output's clock sets the pace; waiting for the screen as well would miss its ticks.
    glfwSwapInterval(0);
    GlInfo::query().require_vantage_minimum();
    glfwSetWindowUserPointer(window_.get(), this);
    // Every event by itself: between two pictures a whole drag may begin and end.
    glfwSetKeyCallback(window_.get(), on_key);
    glfwSetMouseButtonCallback(window_.get(), on_button);
    glfwSetCursorPosCallback(window_.get(), on_cursor);
    ui_.emplace(body_font_px(height_px));
    // Keeps our callbacks and calls them in turn.
    ImGui_ImplGlfw_InitForOther(window_.get(), true);
    renderer_.emplace(shaders_);
}

OperatorWindow::~OperatorWindow() { ImGui_ImplGlfw_Shutdown(); }

bool OperatorWindow::closed() const { return glfwWindowShouldClose(window_.get()) != 0; }

bool OperatorWindow::held(int key) const { return glfwGetKey(window_.get(), key) == GLFW_PRESS; }

void OperatorWindow::on_key(GLFWwindow* window, int key, int, int action, int modifiers) {
    OperatorWindow& self = *static_cast<OperatorWindow*>(glfwGetWindowUserPointer(window));
    if (action == GLFW_RELEASE) return;
    const bool with_control = (modifiers & GLFW_MOD_CONTROL) != 0;
    for (const ControlCommand& command : control_commands()) {
        const int number = number_of_key(command, key, with_control);
        if (number > 0 && (action == GLFW_PRESS || command.key.repeats))
            apply({&command, static_cast<double>(number)}, self.input_);
    }
    if (action == GLFW_PRESS) self.take_key(key);
}

/// Keys that are the window's own.
void OperatorWindow::take_key(int key) {
    switch (key) {
        case GLFW_KEY_F1:
            show_help_ = !show_help_;
            break;
        case GLFW_KEY_TAB:
            show_panels_ = !show_panels_;
            break;
        case GLFW_KEY_ESCAPE:
            // Asks first: a second time within the time ends.
            if (glfwGetTime() < end_asked_until_s_)
                glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
            end_asked_until_s_ = glfwGetTime() + end_asks_s;
            break;
        default:
            break;
    }
}

void OperatorWindow::on_button(GLFWwindow* window, int button, int action, int) {
    OperatorWindow& self = *static_cast<OperatorWindow*>(glfwGetWindowUserPointer(window));
    if (button < 0 || button >= static_cast<int>(self.drags_.size())) return;
    // What begins on a panel is the panel's until the button is up.
    self.drags_[static_cast<std::size_t>(button)] =
        action == GLFW_PRESS && !ImGui::GetIO().WantCaptureMouse;
    if (button == GLFW_MOUSE_BUTTON_LEFT && self.drags_[GLFW_MOUSE_BUTTON_LEFT]) self.take_press();
}

/// Of two presses soon after one another: the place in the picture.
void OperatorWindow::take_press() {
    const double now_s = glfwGetTime();
    const bool is_second = pressed_s_ >= 0 && now_s - pressed_s_ < double_press_s;
    pressed_s_ = is_second ? -1 : now_s;
    if (!is_second || picture_px_.empty()) return;
    // The picture is in the middle, as large as fits.
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const double scale = std::min(static_cast<double>(screen.x) / picture_px_.width,
                                  static_cast<double>(screen.y) / picture_px_.height);
    const Eigen::Vector2d place(0.5 + (cursor_x_ - 0.5 * screen.x) / (scale * picture_px_.width),
                                0.5 + (cursor_y_ - 0.5 * screen.y) / (scale * picture_px_.height));
    if ((place.array() >= 0).all() && (place.array() <= 1).all()) input_.pick = place;
}

void OperatorWindow::on_cursor(GLFWwindow* window, double x, double y) {
    static_cast<OperatorWindow*>(glfwGetWindowUserPointer(window))->take_cursor(x, y);
}

void OperatorWindow::take_cursor(double x, double y) {
    const double width = std::max(ImGui::GetIO().DisplaySize.x, 1.0f);
    const double right = (x - cursor_x_) / width, down = (y - cursor_y_) / width;
    cursor_x_ = x;
    cursor_y_ = y;
    if (drags_[GLFW_MOUSE_BUTTON_LEFT]) {
        // Across the whole window: half a turn. The stage follows the hand.
        input_.orbit_azimuth_rad -= right * std::numbers::pi;
        input_.orbit_elevation_rad += down * std::numbers::pi;
    }
    if (drags_[GLFW_MOUSE_BUTTON_RIGHT] || drags_[GLFW_MOUSE_BUTTON_MIDDLE]) {
        input_.pan_right_widths -= right;
        input_.pan_up_widths += down;
    }
}

void OperatorWindow::take_wheel() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse) return;
    constexpr double per_notch = 0.12;
    (io.KeyCtrl ? input_.zoom : input_.dolly) += per_notch * io.MouseWheel;
}

void OperatorWindow::take_held_keys(double dt_s) {
    constexpr double turn_rad_s = 0.9, pan_widths_s = 0.35, dolly_s = 0.8, zoom_s = 0.6;
    const auto axis = [&](int less, int more) { return held(more) - held(less); };
    input_.orbit_azimuth_rad += dt_s * turn_rad_s * axis(GLFW_KEY_LEFT, GLFW_KEY_RIGHT);
    input_.orbit_elevation_rad += dt_s * turn_rad_s * axis(GLFW_KEY_DOWN, GLFW_KEY_UP);
    input_.pan_right_widths += dt_s * pan_widths_s * axis(GLFW_KEY_A, GLFW_KEY_D);
    input_.pan_up_widths += dt_s * pan_widths_s * axis(GLFW_KEY_Q, GLFW_KEY_E);
    input_.dolly += dt_s * dolly_s * axis(GLFW_KEY_S, GLFW_KEY_W);
    input_.zoom +=
        dt_s * zoom_s *
        (axis(GLFW_KEY_MINUS, GLFW_KEY_EQUAL) + axis(GLFW_KEY_KP_SUBTRACT, GLFW_KEY_KP_ADD));
}

FlightInput OperatorWindow::poll(double dt_s) {
    input_ = {};
    glfwPollEvents();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    take_wheel();
    take_held_keys(dt_s);
    return input_;
}

void OperatorWindow::show(PanelState state) {
    if (state.picture) picture_px_ = state.picture->size();
    state.show_panels = show_panels_;
    state.show_help = show_help_;
    state.asks_to_end = glfwGetTime() < end_asked_until_s_;
    draw_operator_screen(state, ui_->fonts());
    ImGui::Render();
    int width_px = 0, height_px = 0;
    glfwGetFramebufferSize(window_.get(), &width_px, &height_px);
    // A window that is put away has no size.
    if (width_px < 1 || height_px < 1) return;
    if (!screen_ || screen_->target.size() != cv::Size(width_px, height_px))
        screen_ = std::make_unique<Screen>(width_px, height_px);
    renderer_->draw(*ImGui::GetDrawData(), screen_->target);
    // Our pictures have their top in row 0, the window's has its bottom there.
    screen_->target.bind();
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, width_px, height_px, 0, height_px, width_px, 0, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
    check_gl("showing the operator's screen");
    glfwSwapBuffers(window_.get());
}

void OperatorWindow::leave() { ImGui::EndFrame(); }

ColourImage OperatorWindow::screenshot() const {
    return screen_ ? ColourImage(screen_->texture.download()) : ColourImage();
}

}  // namespace vantage
