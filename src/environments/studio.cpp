// A photographer's studio: softboxes in a black room with a rounded floor, as for pictures of glass
// and chrome.
//
// The room is a box with rounded edges and corners around the viewer; its walls are painted nearly
// black and its floor grey. Walls and floor are lit by the softboxes by Lambert's formula for the
// irradiance from a polygon, without shadows, and dim toward what no box faces. That light is
// smooth, so it is computed once for a table of directions. The boxes are drawn exactly.
//
// Radiance 1 is a white sheet's where the viewer stands, lit by the key light alone, about.
#include <array>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "environment.h"
#include "shading.h"

namespace mirrorball::detail {
namespace {

// Metres; the viewer is at the origin.
const Vec3d kRoomCentre{0, 1.05, 0}, kRoomHalfSize{4.6, 2.3, 4.6};
constexpr double kRounding = 2.1;
constexpr double kWallAlbedo = 0.006, kFloorAlbedo = 0.22;
constexpr double kStray = 0.01;  // light in the room that comes from nowhere in particular

// A rectangle of light with a rounded rim. It shines to one side: toward the viewer.
struct Softbox {
    Vec3d centre;
    double half_width, half_height;
    double roll;                     // radians, about the way it shines
    Vec3d radiance;                  // at its middle
    double falloff;                  // share that is lost at its corners
    int strips_across, strips_down;  // panes of its window frame
};

const std::array kSoftboxes{
    // key: large, high to the left ahead, warm white
    Softbox{{-2.3, 1.5, -2.3}, 0.9, 1.2, radians(-8), {14.0, 13.0, 11.8}, 0.75, 1, 1},
    // fill: larger and weak, to the right, cool
    Softbox{{3.3, 0.7, -0.9}, 1.1, 1.4, radians(4), {0.62, 0.75, 0.92}, 0.7, 1, 1},
    // two strip lights behind that draw bright rims
    Softbox{{-2.6, 0.5, 2.6}, 0.2, 1.5, radians(0), {3.9, 4.1, 4.5}, 0.6, 1, 1},
    Softbox{{2.2, 0.6, 3.0}, 0.2, 1.5, radians(0), {5.2, 4.75, 4.1}, 0.6, 1, 1},
    // overhead: a window of three by two panes
    Softbox{{0.4, 2.7, 0.5}, 0.95, 0.65, radians(12), {2.0, 2.05, 2.15}, 0.6, 3, 2},
    // a small low kicker, amber, for colour in the floor
    Softbox{{1.3, -0.75, -3.2}, 0.6, 0.17, radians(0), {2.6, 1.25, 0.42}, 0.6, 1, 1},
};

// Lamps hidden behind the boxes wash the black walls with a little colour.
struct Wash {
    Vec3d direction;  // of the brightest place
    double width;     // radians
    Vec3d radiance;
};
const std::array kWashes{
    Wash{direction_at(radians(9), radians(12)), radians(27), {0.036, 0.072, 0.120}},
    Wash{direction_at(radians(14), radians(-172)), radians(31), {0.050, 0.028, 0.036}},
};

// A softbox in the frame that it shines from.
struct Frame {
    Vec3d right, up, normal;  // normal: the way it shines
    std::array<Vec3d, 4> corners;

    explicit Frame(const Softbox& box) : normal(-box.centre.normalized()) {
        const Vec3d level = std::abs(normal.y) < 0.95 ? Vec3d(0, 1, 0) : Vec3d(0, 0, -1);
        const Vec3d r = level.cross(normal).normalized(), u = normal.cross(r);
        right = r * std::cos(box.roll) + u * std::sin(box.roll);
        up = u * std::cos(box.roll) - r * std::sin(box.roll);
        const Vec3d x = right * box.half_width, y = up * box.half_height;
        corners = {box.centre - x - y, box.centre - x + y, box.centre + x + y, box.centre + x - y};
    }
};

// Irradiance at a point with a normal from a polygon of radiance 1, none of it below the horizon:
// half the sum over the edges of their angle times the cosine of their plane's tilt (Lambert 1760).
// The part below the horizon is not cut off but faded out.
double polygon_irradiance(const std::array<Vec3d, 4>& corners, const Vec3d& point,
                          const Vec3d& normal) {
    Vec3d sum(0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = (corners[i] - point).normalized();
        const Vec3d b = (corners[(i + 1) % corners.size()] - point).normalized();
        const Vec3d across = a.cross(b);
        const double sine = across.length();
        if (sine > 1e-12) sum += across * (std::atan2(sine, a.dot(b)) / sine);
    }
    // The vector irradiance: its length is what a surface that faces the light would get.
    const double length = 0.5 * sum.length();
    const double cosine = length > 0 ? 0.5 * std::abs(sum.dot(normal)) / length : 0;
    Vec3d middle(0);
    for (const Vec3d& corner : corners) middle += (corner - point) * 0.25;
    const double side = middle.normalized().dot(normal);
    return length * cosine * smoothstep(-0.1, 0.25, side);
}

class Studio final : public Environment {
  public:
    Studio() {
        for (const Softbox& box : kSoftboxes) frames_.emplace_back(box);
        fill_room();
    }

    [[nodiscard]] Vec3d radiance(const Vec3d& direction) const override {
        // The nearest box, or its frame, if any.
        double nearest = 1e9;
        Vec3d light(0);
        for (std::size_t i = 0; i < kSoftboxes.size(); ++i) {
            const double cosine = -direction.dot(frames_[i].normal);
            if (cosine <= 0) continue;
            const double distance = -kSoftboxes[i].centre.dot(frames_[i].normal) / cosine;
            if (distance < nearest && face(i, direction * distance, light)) nearest = distance;
        }
        return nearest < 1e9 ? light : room(direction);
    }
    [[nodiscard]] double detail() const override { return radians(0.25); }

  private:
    // Whether a point in the plane of a box is on it, and the radiance there.
    [[nodiscard]] bool face(std::size_t index, const Vec3d& point, Vec3d& light) const {
        const Softbox& box = kSoftboxes[index];
        const Vec3d offset = point - box.centre;
        const double x = offset.dot(frames_[index].right), y = offset.dot(frames_[index].up);

        constexpr double kRim = 0.035, kCorner = 0.05;  // the black frame around the cloth
        const double out_x = std::max(std::abs(x) - box.half_width + kCorner, 0.0);
        const double out_y = std::max(std::abs(y) - box.half_height + kCorner, 0.0);
        const double outside = std::hypot(out_x, out_y) - kCorner;
        if (outside > kRim) return false;
        if (outside > 0) {
            light = Vec3d(0.004);
            return true;
        }
        if (on_bar(x, box.half_width, box.strips_across) ||
            on_bar(y, box.half_height, box.strips_down)) {
            light = Vec3d(0.02);
            return true;
        }
        // The lamp behind the cloth: brightest in the middle, cosine-like toward the corners.
        const double u = x / box.half_width, v = y / box.half_height;
        const double r2 = 0.5 * (u * u + v * v);
        light = box.radiance * (1 - box.falloff * r2 * (1.5 - 0.5 * r2));
        return true;
    }

    static bool on_bar(double x, double half_size, int panes) {
        constexpr double kHalfBar = 0.018;
        if (panes == 1) return false;
        const double pane = 2 * half_size / panes;
        const double nearest = std::round((x + half_size) / pane);
        return nearest > 0 && nearest < panes &&
               std::abs(x + half_size - nearest * pane) < kHalfBar;
    }

    // Distance from the room's inside to its rounded wall.
    static double distance_to_wall(const Vec3d& p) {
        const Vec3d q = p - kRoomCentre;
        const Vec3d past{std::abs(q.x) - kRoomHalfSize.x + kRounding,
                         std::abs(q.y) - kRoomHalfSize.y + kRounding,
                         std::abs(q.z) - kRoomHalfSize.z + kRounding};
        const Vec3d out{std::max(past.x, 0.0), std::max(past.y, 0.0), std::max(past.z, 0.0)};
        const double inside = std::min(std::max({past.x, past.y, past.z}), 0.0);
        return kRounding - out.length() - inside;
    }

    [[nodiscard]] Vec3d lit_wall(const Vec3d& direction) const {
        double distance = 0;
        for (int i = 0; i < 64; ++i) distance += distance_to_wall(direction * distance);
        const Vec3d point = direction * distance;
        constexpr double e = 1e-4;
        const auto slope = [&](const Vec3d& axis) {
            return distance_to_wall(point + axis * e) - distance_to_wall(point - axis * e);
        };
        const Vec3d normal =
            Vec3d(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})).normalized();

        // The floor's grey runs up the curve and fades into the walls' black.
        const double up = smoothstep(0.1, 0.97, normal.y);
        const double albedo = mix(kWallAlbedo, kFloorAlbedo, up);
        Vec3d irradiance(kPi * kStray);
        for (std::size_t i = 0; i < kSoftboxes.size(); ++i) {
            // A box shines to one side only.
            const double before = (point - kSoftboxes[i].centre).dot(frames_[i].normal);
            if (before <= 0) continue;
            const double edge = smoothstep(0, 2.5, before);
            irradiance += kSoftboxes[i].radiance * (1 - 0.6 * kSoftboxes[i].falloff) *
                          (edge * polygon_irradiance(frames_[i].corners, point, normal));
        }
        Vec3d light = irradiance * (albedo / kPi);
        for (const Wash& wash : kWashes) {
            const double angle = std::acos(std::clamp(direction.dot(wash.direction), -1.0, 1.0));
            light += wash.radiance * std::exp(-std::pow(angle / wash.width, 2));
        }
        return light;
    }

    // The room by longitude and latitude: rows from -Y to +Y, poles included.
    static constexpr int kWidth = 256, kHeight = 129;

    void fill_room() {
        room_.resize(kWidth * kHeight);
        parallel_for(kHeight, [&](std::int64_t j) {
            const double elevation = kPi * (static_cast<double>(j) / (kHeight - 1) - 0.5);
            for (int i = 0; i < kWidth; ++i)
                room_[j * kWidth + i] = lit_wall(direction_at(elevation, 2 * kPi * i / kWidth));
        });
    }

    [[nodiscard]] Vec3d room(const Vec3d& direction) const {
        const double azimuth = std::atan2(direction.x, -direction.z);
        const double elevation = std::atan2(direction.y, std::hypot(direction.x, direction.z));
        const double x = (azimuth / (2 * kPi) + 1) * kWidth;
        const double y = std::clamp((elevation / kPi + 0.5) * (kHeight - 1), 0.0, kHeight - 1.001);
        const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
        const auto at = [&](int i, int j) { return room_[j * kWidth + i % kWidth]; };
        const double u = x - x0, v = y - y0;
        return mix(mix(at(x0, y0), at(x0 + 1, y0), u), mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), u),
                   v);
    }

    std::vector<Frame> frames_;
    std::vector<Vec3d> room_;
};

}  // namespace

std::unique_ptr<Environment> make_studio() {
    return std::make_unique<Studio>();
}

}  // namespace mirrorball::detail
