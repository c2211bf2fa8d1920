// Viewer: what a window and a web page that show a scene live have in common: the scene, how it is
// compared, what the mouse and keys do to it, files dropped on it. Knows no window and no toolkit.
//
// It draws into the framebuffer that is bound, in the current OpenGL context, and remembers nothing
// but its members: a Viewer that is given the same state draws the same picture.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/io.h>
#include <mirrorball/map_pictures.h>
#include <mirrorball/progress.h>
#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

namespace mirrorball {

/// What there is to see: the scene by its method, that beside another, or how the two differ.
enum class Showing { one, wipe, difference };
/// "one", "wipe", "difference"
[[nodiscard]] std::string_view name(Showing showing);
/// \throws Error(Errc::usage) naming those there are
[[nodiscard]] Showing parse_showing(std::string_view name);

/// Of a second method.
struct Comparison {
    Showing showing = Showing::one;
    Method other = Method::sphere_vertex;
    /// The scene's method is to the left of this share of the picture's width, the other to the
    /// right; 0 to 1.
    double wipe = 0.5;
    /// The largest difference of a channel, as a screen shows it from 0 to 1, that is white in the
    /// false colours: black, violet, red, orange, white. 0.001 to 1.
    double full_scale = 0.2;

    bool operator==(const Comparison&) const = default;
};

/// What a pixel sees.
struct Hover {
    std::optional<std::size_t> object;  ///< its place in the scene; none: the background
    /// Of the world; the normal is unit, on the eye's side, as bumps of the form `normals` have it.
    Vec3d position{0}, normal{0};
    /// What the map is asked for, bumps of the classic form included; of the background, where one
    /// looks.
    Vec3d reflected{0, 0, -1};
    std::optional<Vec3d> refracted;  ///< of glass, where light gets through
};

/// 8 bits a channel, encoded as sRGB, top row first; alpha is not.
struct ScreenPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    std::uint64_t version = 0;  ///< another one whenever it has been made anew
};

/// What a map in a picture holds: the environment, or it as blurred by the first glossy lobe of the
/// scene, or what a diffuse surface receives.
enum class MapContent { environment, glossy, diffuse };
[[nodiscard]] std::string_view name(MapContent content);

/// A key, as browsers name it ("ArrowLeft", "m", "M" with shift), and what it does.
struct KeyHelp {
    std::string keys, what;
};

/// What became of something dropped on the viewer, in the words in which the program would tell it.
struct Dropped {
    bool taken = false;
    std::string message;
};

class Viewer {
  public:
    struct Options {
        std::uint64_t memory_limit = kUnlimitedMemory;  ///< of what is loaded
        /// Pictures that differ by parts of a pixel and are averaged while nothing changes: as
        /// Renderer::picture() has them. 1: none.
        int sample_count = 8;
        /// Of built-in environments, in texels; 0: the usual ones. They take seconds to draw, so
        /// who draws them elsewhere has coarse ones until drop_environment() brings the whole.
        int builtin_width = 0;
        Progress reading = {};       ///< of an environment, as MapReadOptions has it
        Progress prefiltering = {};  ///< of a picture's maps, where it needs new ones
    };

    /// A teapot of chrome in the sunset. \pre an OpenGL context is current, here and in all else
    Viewer();
    /// Names in the scene are those of files beside `folder`. \throws Error as load_assets() does
    Viewer(const Scene& scene, const std::filesystem::path& folder, const Options& options);
    ~Viewer();
    Viewer(Viewer&&) noexcept;
    Viewer& operator=(Viewer&&) noexcept;

    // What is shown
    // ------------------------------------------------------------------------------------------

    [[nodiscard]] const Scene& scene() const;
    /// This scene edited: what it names and was not loaded is. \throws Error as load_assets() does;
    /// nothing has changed then
    void set_scene(const Scene& scene);
    /// Another scene, whose names are files beside `folder`. Throws likewise.
    void open_scene(const Scene& scene, const std::filesystem::path& folder);
    /// Where relative names in the scene are found; empty: where the program runs.
    [[nodiscard]] const std::filesystem::path& folder() const;

    [[nodiscard]] const Comparison& comparison() const;
    /// Numbers out of range are brought into it.
    void set_comparison(const Comparison& comparison);

    /// Exposure in stops from what suits the environment.
    [[nodiscard]] double exposure_stops() const;
    void set_exposure_stops(double stops);

    /// The one that all of the material's controls are about: that of the object that was chosen.
    [[nodiscard]] std::size_t selected() const;
    void select(std::size_t object);

    [[nodiscard]] const SceneAssets& assets() const;
    /// The exposure in use, chosen or the environment's.
    [[nodiscard]] double exposure() const;
    /// Facts about the environment as it was read: its format, guesses made, ...
    [[nodiscard]] const std::vector<std::string>& environment_notes() const;

    // Files
    // ------------------------------------------------------------------------------------------

    /// A file by its ending and contents: an environment, a mesh, which takes the place of the
    /// selected object's, or a scene (.json). What cannot be read changes nothing.
    Dropped drop(const std::filesystem::path& path);
    /// An environment that is in memory, under the name by which messages call it.
    Dropped drop_environment(const std::string& name, LoadedMap map);

    /// The scene as a file, whole or not at all; files are named relative to its folder where they
    /// are in it. \throws Error(Errc::cannot_write)
    void save_scene(const std::filesystem::path& path) const;

    /// All of the state, as a line of text: for links. \throws Error as parse_scene() and
    /// set_scene() do; nothing has changed then
    [[nodiscard]] std::string state() const;
    void set_state(std::string_view state);

    // By hand: pixels are those of a picture `height` pixels high
    // ------------------------------------------------------------------------------------------

    /// What is under the mouse turns with it: half a turn in a picture's height.
    void orbit(double dx, double dy, int height);
    void pan(double dx, double dy, int height);
    /// Wheel steps; positive is nearer.
    void zoom(double steps);
    /// Turns the environment about +y, half a turn in a picture's height.
    void turn_environment(double dx, int height);
    /// All objects in a picture of that shape, from the usual place.
    void frame_all(double aspect);

    /// \return  whether the key does anything
    bool press(std::string_view key, double aspect);
    [[nodiscard]] static std::span<const KeyHelp> keys();

    // Pictures
    // ------------------------------------------------------------------------------------------

    /// Into the framebuffer that is bound, as sRGB, from this pixel to the right and upwards;
    /// leaves it bound. While nothing changes, each call makes the picture smoother until it is.
    /// Where the framebuffer has a depth buffer, that is drawn into, too, and what moves is quicker
    /// by a copy of the picture; nothing around it is touched.
    /// \throws Error as Renderer does; the scene is then the last that could be drawn
    void draw(int width, int height, int left = 0, int bottom = 0);
    /// Has the picture all the samples that it gets while nothing changes?
    [[nodiscard]] bool is_smooth() const;
    /// As long as something is held, a slider or the scene, pictures stay the first, quickest ones:
    /// of GGX that is too sharp to be prefiltered within a frame they show an approximation
    /// (DrawOptions::quick).
    void hold(bool held);

    /// Of the pixel in column x and row y from the top left.
    [[nodiscard]] Hover hover(double x, double y, int width, int height) const;

    /// Where a direction is looked up in a map of this projection. Sphere maps are looked up in the
    /// camera's axes, the stale one, too.
    [[nodiscard]] MapPlace place_on_map(Projection projection, const Vec3d& direction) const;
    /// A small picture of a map as the method has it, the sphere map for the camera unless it is
    /// stale; tone mapped as the scene is, transparent where there is no map.
    /// Kept until it changes: cheap to ask for again.
    [[nodiscard]] const ScreenPicture& map_picture(MapContent content, Projection projection,
                                                   int height);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mirrorball
