#include <mirrorball/axes.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/projection.h>

namespace mirrorball {
namespace {

// Every frame of a preset lies along the world's axes, so its text form says it all. A program
// whose own world is not ours (Blender and RenderMan: z up; Unity, RenderMan, pbrt: left-handed) is
// entered after its world has been turned into ours: Blender (x, z, -y), RenderMan and pbrt (x, z,
// y), Unity (x, y, -z). Sources of the forward maps: docs/conventions.md.
struct Preset {
    std::string_view program;
    Projection projection;
    std::string_view frame;
    std::string_view description;
};

constexpr Preset kPresets[] = {
    {"debevec", Projection::equirect, "+x+y+z", "high-resolution probes: centre -Z"},
    {"three.js", Projection::equirect, "+z+y-x", "centre +X"},
    {"gltf", Projection::equirect, "+z+y-x", "glTF sampler: centre +X"},
    {"openexr", Projection::equirect, "-x+y-z", "lat-long environment: centre +Z"},
    {"oiio", Projection::equirect, "+z+y-x", "OpenImageIO, its default of z up: centre +X"},
    {"oiio-y-up", Projection::equirect, "-x+y-z", "OpenImageIO, y up: centre +Z"},
    {"mitsuba", Projection::equirect, "-x+y-z", "Mitsuba 3: centre +Z"},
    {"renderman", Projection::equirect, "+z+y-x", "centre +X"},
    {"blender", Projection::equirect, "+z+y-x", "centre +X"},
    {"unity", Projection::equirect, "+z+y-x", "centre +X"},
    {"cmft", Projection::equirect, "+x+y+z", "centre on the cube's +Z, which is ahead"},
    {"opengl", Projection::cube, "+x+y+z", "looked up with the world direction itself"},
    {"vulkan", Projection::cube, "+x+y+z", "looked up with the world direction itself"},
    {"direct3d", Projection::cube, "+x+y-z", "left-handed world, +Z ahead"},
    {"unity", Projection::cube, "+x+y-z", "left-handed world, +Z ahead"},
    {"cmft", Projection::cube, "+x+y-z", "left-handed world, +Z ahead"},
    {"openexr", Projection::cube, "+x+y-z", "its +Z and -Z images are swapped on reading"},
    {"three.js", Projection::cube, "-x+y+z", "looked up with world x negated"},
    {"filament", Projection::cube, "-x+y+z", "cmgen's mirrored x"},
    {"pbrt", Projection::equal_area_octahedral, "+x+z+y", "z up, left-handed: fold axis up"},
    {"debevec", Projection::angular, "+x+y+z", "centre -Z"},
    {"angular+z", Projection::angular, "+x+y-z", "centre +Z, the other reading of Debevec's page"},
    {"fold-z", Projection::octahedral, "+x+y+z", "centre +Z"},
    {"fold-y", Projection::octahedral, "+x-z+y", "centre +Y, +Z at the bottom"},
    {"fold-z", Projection::equal_area_octahedral, "+x+y+z", "centre +Z"},
    {"fold-y", Projection::equal_area_octahedral, "+x-z+y", "centre +Y, +Z at the bottom"},
};

constexpr std::string_view kOurs = "mirrorball";

bool parse_signed_axis(std::string_view text, Vec3d& axis) {
    if (text[0] != '+' && text[0] != '-') return false;
    const std::size_t index = std::string_view("xyz").find(text[1]);
    if (index == std::string_view::npos) return false;
    axis = {0, 0, 0};
    axis[static_cast<int>(index)] = text[0] == '+' ? 1 : -1;
    return true;
}

bool orthonormal(const Axes& a) {
    constexpr double tolerance = 1e-6;  // nine numbers written with 9 digits or more
    const auto near = [](double value, double expected) {
        return std::abs(value - expected) < tolerance;
    };
    return near(a.x.dot(a.x), 1) && near(a.y.dot(a.y), 1) && near(a.z.dot(a.z), 1) &&
           near(a.x.dot(a.y), 0) && near(a.y.dot(a.z), 0) && near(a.z.dot(a.x), 0);
}

bool parse_frame(std::string_view text, Axes& axes) {
    if (text.size() != 6) return false;
    return parse_signed_axis(text.substr(0, 2), axes.x) &&
           parse_signed_axis(text.substr(2, 2), axes.y) &&
           parse_signed_axis(text.substr(4, 2), axes.z) && orthonormal(axes);
}

bool parse_nine_numbers(std::string_view text, Axes& axes) {
    const std::string copy(text);
    const char* rest = copy.c_str();
    for (Vec3d* axis : {&axes.x, &axes.y, &axes.z}) {
        for (int i = 0; i < 3; ++i) {
            char* end = nullptr;
            (*axis)[i] = std::strtod(rest, &end);
            if (end == rest) return false;
            rest = end;
        }
    }
    return rest == copy.c_str() + copy.size() && orthonormal(axes);
}

// "+x" if the axis lies along one of the world's, else nothing.
std::string signed_axis(const Vec3d& axis) {
    for (int i = 0; i < 3; ++i) {
        Vec3d along(0, 0, 0);
        for (const double sign : {1.0, -1.0}) {
            along[i] = sign;
            if (axis == along) return fmt::format("{}{}", sign > 0 ? '+' : '-', "xyz"[i]);
        }
    }
    return {};
}

Vec3d turn(const Vec3d& v, const Vec3d& axis, double angle) {
    // Rodrigues; exact quarter turns keep exact axes
    const double quarter = angle / (kPi / 2), rounded = std::round(quarter);
    double cosine = std::cos(angle), sine = std::sin(angle);
    if (std::abs(quarter - rounded) < 1e-12) {
        const int step = static_cast<int>(std::fmod(std::fmod(rounded, 4) + 4, 4));
        cosine = step == 0 ? 1 : step == 2 ? -1 : 0;
        sine = step == 1 ? 1 : step == 3 ? -1 : 0;
    }
    // + 0.0 turns -0 into 0, so that equal frames print alike
    return v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1 - cosine)) + Vec3d(0.0);
}

}  // namespace

Axes default_axes(Projection projection) {
    Axes axes;
    if (projection == Projection::cube) axes.z = {0, 0, -1};
    return axes;
}

Axes axes_preset(std::string_view program, Projection projection) {
    if (program == kOurs) return default_axes(projection);
    std::string known(kOurs);
    for (const Preset& preset : kPresets) {
        if (preset.projection != projection) continue;
        Axes axes;
        if (preset.program == program && parse_frame(preset.frame, axes)) return axes;
        known += fmt::format(", {}", preset.program);
    }
    throw Error(Errc::usage, fmt::format("no axes preset \"{}\" for {} maps; there are {}", program,
                                         name(projection), known));
}

std::vector<AxesPreset> axes_presets() {
    std::vector<AxesPreset> presets = {
        {std::string(kOurs), "every projection: right-handed, +Y up, -Z ahead (default)"}};
    for (const Preset& preset : kPresets) {
        const std::string what = fmt::format("{}: {}", name(preset.projection), preset.description);
        const auto same = std::find_if(presets.begin(), presets.end(), [&](const AxesPreset& p) {
            return p.name == preset.program;
        });
        if (same != presets.end())
            same->description += "; " + what;
        else
            presets.push_back({std::string(preset.program), what});
    }
    return presets;
}

std::string to_string(const Axes& axes) {
    const std::string x = signed_axis(axes.x), y = signed_axis(axes.y), z = signed_axis(axes.z);
    if (!x.empty() && !y.empty() && !z.empty()) return x + y + z;
    std::string text;
    for (const Vec3d& axis : {axes.x, axes.y, axes.z})
        text += fmt::format("{}{} {} {}", text.empty() ? "" : " ", axis.x, axis.y, axis.z);
    return text;
}

Axes parse_axes(std::string_view text, Projection projection) {
    Axes axes;
    if (parse_frame(text, axes) || parse_nine_numbers(text, axes)) return axes;
    if (!text.empty() && (text[0] == '+' || text[0] == '-'))
        throw Error(Errc::usage,
                    fmt::format("axes \"{}\": expected three different axes such as +x+y-z", text));
    return axes_preset(text, projection);
}

Axes rotated(const Axes& axes, double yaw, double pitch, double roll) {
    const auto turned = [&](const Vec3d& v) {
        const Vec3d yawed = turn(v, {0, 1, 0}, yaw);
        const Vec3d pitched = turn(yawed, {1, 0, 0}, pitch);
        return turn(pitched, {0, 0, -1}, roll);
    };
    return {turned(axes.x), turned(axes.y), turned(axes.z)};
}

Axes mirrored(const Axes& axes) {
    const auto mirror = [](const Vec3d& v) { return Vec3d(0.0 - v.x, v.y, v.z); };
    return {mirror(axes.x), mirror(axes.y), mirror(axes.z)};
}

}  // namespace mirrorball
