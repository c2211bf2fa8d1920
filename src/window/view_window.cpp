// The loop: what came in, the picture, the controls, the screen.
#include "view_window.h"

#include <chrono>
#include <cmath>
#include <optional>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <mirrorball/error.h>
#include <mirrorball/io.h>

#include "desktop.h"
#include "gl/check.h"
#include "gl/objects.h"
#include "io/codec.h"
#include "map_strip.h"
#include "overlay.h"
#include "panel.h"
#include "session.h"
#include "theme.h"
#include "work_bar.h"

namespace mirrorball::window {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPanelWidth = 330;  // at scale 1
constexpr double kIdleSeconds = 0.25;

// ImGui with its backends, as long as the window is there.
class Interface {
  public:
    explicit Interface(GLFWwindow* window) {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;  // nothing is remembered
        ImGui_ImplGlfw_InitForOpenGL(window, true);
        ImGui_ImplOpenGL3_Init("#version 330 core");
    }
    ~Interface() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    void set_scale(double scale) {
        apply_theme(scale);
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
    }
};

// Bytes of a framebuffer as linear light, which a picture's file encodes to the same bytes.
Image read_pixels(int left, int bottom, int width, int height) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(width) * height * 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(left, bottom, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    gl::check("reading the window's picture");
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* row = bytes.data() + std::size_t{4} * width * (height - 1 - y);
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] =
                    detail::srgb_to_linear(static_cast<float>(row[4 * x + c]) / 255);
    }
    return image;
}

bool is_scripted(const Options& options) {
    return options.frames > 0;
}

class ViewWindow {
  public:
    ViewWindow(const MakeViewer& make_viewer, const Options& options, Desktop& desktop)
        : options_(options),
          desktop_(desktop),
          work_bar_(desktop, options.stop),
          interface_(desktop.handle()),
          viewer_(make_viewer(work_bar_.progress("Reading"), work_bar_.progress("Prefiltering"))),
          session_(viewer_) {
        session_.panel_open = options.panel;
    }

    Report run();

  private:
    [[nodiscard]] bool is_done(int frame) const;
    void wait();
    void take_events();
    void take_step();
    void take_lobe();
    void do_step(const ResizeStep& step);
    void do_step(const DropStep& step) { session_.drop(step.file); }
    void do_step(const KeyStep& step) { session_.press(step.key); }
    void do_step(const DragStep& step) { drag_ = step; }
    void do_step(const LobeStep& step) { lobe_.emplace(step, 0); }
    void do_step(const WaitStep& step) { waiting_ = step.frames - 1; }
    void lay_out();
    void draw_frame();
    void draw_picture();
    void write_screenshot(const std::filesystem::path& path);
    void take_picture_asked();

    Options options_;
    Desktop& desktop_;
    WorkBar work_bar_;
    Interface interface_;
    Viewer viewer_;
    Session session_;
    MapStrip strip_;
    std::size_t next_step_ = 0;
    int waiting_ = 0;
    std::optional<DragStep> drag_;
    std::optional<std::pair<LobeStep, int>> lobe_;  // and how many of its frames were
    double applied_scale_ = 0;
    int lively_frames_ = 3;  // drawn without waiting: controls settle in a few frames
    Area panel_, maps_;
};

bool ViewWindow::is_done(int frame) const {
    if (desktop_.is_closed() || session_.quit) return true;
    return is_scripted(options_) && frame >= options_.frames &&
           next_step_ == options_.script.size() && waiting_ == 0 && !drag_ && !lobe_;
}

// Only while there is nothing to draw.
void ViewWindow::wait() {
    const bool busy =
        is_scripted(options_) || lively_frames_ > 0 || session_.time_runs || !viewer_.is_smooth();
    lively_frames_ = std::max(0, lively_frames_ - 1);
    if (busy) return desktop_.wait(0);
    const Clock::time_point start = Clock::now();
    desktop_.wait(kIdleSeconds);
    if (std::chrono::duration<double>(Clock::now() - start).count() < kIdleSeconds)
        lively_frames_ = 3;
}

void ViewWindow::take_events() {
    const Events events = desktop_.take_events();
    for (const std::string& file : events.dropped) session_.drop(file);
    if (ImGui::GetIO().WantTextInput) return;
    for (const std::string& key : events.keys) session_.press(key);
}

// Sizes are asked for, and come when the screen has made them.
void ViewWindow::do_step(const ResizeStep& step) {
    constexpr int kPatience = 200;
    desktop_.resize(step.width, step.height);
    for (int i = 0; i < kPatience && !(desktop_.pixels() == Desktop::Size{step.width, step.height});
         ++i)
        desktop_.wait(0.01);
}

void ViewWindow::take_step() {
    if (drag_) {
        viewer_.orbit(drag_->dx / drag_->frames, drag_->dy / drag_->frames,
                      std::max(1, session_.picture.height));
        drag_->dx -= drag_->dx / drag_->frames;
        drag_->dy -= drag_->dy / drag_->frames;
        if (--drag_->frames == 0) drag_.reset();
        return;
    }
    if (lobe_) return take_lobe();
    if (waiting_ > 0) {
        --waiting_;
        return;
    }
    if (next_step_ == options_.script.size()) return;
    std::visit([&](const auto& step) { do_step(step); }, options_.script[next_step_++]);
}

// As the slider of the material's controls does.
void ViewWindow::take_lobe() {
    const LobeStep& step = lobe_->first;
    const double share = step.frames > 1 ? lobe_->second / (step.frames - 1.0) : 1;
    const double value = step.from + (step.to - step.from) * share;
    session_.edit([&](Scene& scene) {
        if (viewer_.selected() < scene.objects.size())
            scene.objects[viewer_.selected()].material.lobe =
                parse_lobe(fmt::format("{}:{}", step.kind, value));
    });
    if (++lobe_->second == step.frames) lobe_.reset();
}

// The panel at the right and the maps below take what the picture can spare.
void ViewWindow::lay_out() {
    const double scale = options_.scale > 0 ? options_.scale : desktop_.scale();
    if (scale != applied_scale_) interface_.set_scale(scale);
    applied_scale_ = session_.scale = scale;
    const auto [width, height] = desktop_.pixels();
    const int panel_width = static_cast<int>(kPanelWidth * scale);
    session_.picture = {0, 0, width, height};
    panel_ = maps_ = {};
    if (!session_.panel_open || width < 2 * panel_width) return;
    session_.picture.width = width - panel_width;
    panel_ = {static_cast<double>(width - panel_width), 0, panel_width, height};
}

void ViewWindow::draw_picture() {
    const auto [width, height] = desktop_.pixels();
    const Area& area = session_.picture;
    if (area.width < 1 || area.height < 1) return;
    const int bottom = height - area.height - static_cast<int>(area.top);
    viewer_.hold(!is_scripted(options_) && ImGui::IsAnyMouseDown());
    const auto draw = [&] {
        viewer_.draw(area.width, area.height, static_cast<int>(area.left), bottom);
    };
    // A script has no one to tell.
    if (is_scripted(options_)) {
        draw();
    } else {
        session_.attempt(draw);
    }
}

// Into the framebuffer that is bound.
void ViewWindow::draw_frame() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (panel_.width > 0) {
        const int strip = MapStrip::height_for(session_.picture.width, session_.scale);
        if (session_.picture.height > 2 * strip) {
            session_.picture.height -= strip;
            maps_ = {0, static_cast<double>(session_.picture.height), session_.picture.width,
                     strip};
        }
    }
    draw_overlay(session_);
    if (panel_.width > 0) draw_panel(session_, panel_);
    if (maps_.width > 0) strip_.draw(session_, maps_);
    ImGui::Render();
    draw_picture();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

// What the window shows, with its controls if they are there. From a framebuffer of our own: what
// is hidden of a window has no pixels.
void ViewWindow::write_screenshot(const std::filesystem::path& path) {
    const auto [width, height] = desktop_.pixels();
    const gl::Framebuffer framebuffer;
    const gl::Renderbuffer picture;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glBindRenderbuffer(GL_RENDERBUFFER, picture.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              picture.name());
    gl::check_framebuffer("making room for a picture of the window");
    draw_picture();
    if (session_.panel_open) ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    const Image image = read_pixels(0, 0, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    write_image(path, image);
}

void ViewWindow::take_picture_asked() {
    session_.screenshot_asked = false;
    session_.attempt([&] {
        std::filesystem::path path;
        for (int i = 1; path.empty() || std::filesystem::exists(path); ++i)
            path = fmt::format("mirrorball-{}.png", i);
        write_screenshot(path);
        session_.tell(fmt::format("{} is written", path.string()));
    });
}

Report ViewWindow::run() {
    Report report;
    report.driver = gl::driver();
    const Clock::time_point begin = Clock::now();
    for (int frame = 0; !is_done(frame); ++frame) {
        if (options_.stop && options_.stop())
            throw Error(Errc::cancelled, "the window was closed by a signal");
        wait();
        const Clock::time_point start = Clock::now();
        const double now = std::chrono::duration<double>(start - begin).count();
        if (session_.time_runs)
            session_.edit([&](Scene& scene) { scene.time += now - session_.clock; });
        session_.clock = now;
        take_events();
        take_step();
        lay_out();
        draw_frame();
        if (session_.screenshot_asked) take_picture_asked();
        desktop_.swap();
        work_bar_.end();
        if (is_scripted(options_)) glFinish();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        report.seconds.push_back(seconds);
        session_.frame_seconds += (seconds - session_.frame_seconds) * 0.2;
    }
    if (!options_.screenshot.empty()) write_screenshot(options_.screenshot);
    return report;
}

}  // namespace

Report show(const MakeViewer& make_viewer, const Options& options) {
    Desktop desktop(options.width, options.height, !is_scripted(options));
    try {
        return ViewWindow(make_viewer, options, desktop).run();
    } catch (const Error& error) {
        // Closed before there was anything to see.
        if (error.code() == Errc::cancelled && desktop.is_closed()) return {};
        throw;
    }
}

}  // namespace mirrorball::window
