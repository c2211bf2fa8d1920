// Section 2 of the survey: polygons split where their reflections cross from one face of the cube
// to the next.
//
// Over a triangle r is linear in the barycentric coordinates, and the directions of a face are a
// cone between four planes such as r_x = r_y. So each piece is the triangle clipped by four lines.
// For pieces to meet to the bit, no point is ever computed from another computed one. A corner of a
// piece is one of three things, and each is found from what defines it, in an order that does not
// depend on who asks:
//
//     a corner of the triangle
//     the crossing of an edge of the triangle and a plane: from the edge's two ends, sorted
//     the meeting of two planes: where r is parallel to a diagonal of the cube, from all three
//
// Rounding must not let two faces disagree about the side on which a point lies. So the components
// of r that are equal by definition are made equal to the bit; then "x > z" and "y > z" agree on
// the plane x = y. And a point between two that are on one side of a plane, or in it, is so too.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <mirrorball/mesh.h>
#include <mirrorball/projections/cube.h>

namespace mirrorball {
namespace {

constexpr int kFaces = 6;

// The half-space sign r[axis] >= side r[other] beside a face.
struct Plane {
    int axis, other;
    double sign, side;

    [[nodiscard]] double distance(const Vec3d& r) const { return sign * r[axis] - side * r[other]; }
};

// The planes around a face, in the faces' order +X -X +Y -Y +Z -Z.
constexpr std::array<Plane, 4> planes_of(int face) {
    const int axis = face / 2;
    const int b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2;
    const double sign = face % 2 == 0 ? 1 : -1;
    return {{{axis, b, sign, 1}, {axis, b, sign, -1}, {axis, c, sign, 1}, {axis, c, sign, -1}}};
}

struct Corner {
    Vec3f position, normal;
    Vec3d r;
    std::uint32_t index;  // in the mesh that is split, or kNew
};
constexpr std::uint32_t kNew = std::numeric_limits<std::uint32_t>::max();

bool in_order(const Corner& a, const Corner& b) {
    for (int i = 0; i < 3; ++i)
        if (a.position[i] != b.position[i]) return a.position[i] < b.position[i];
    for (int i = 0; i < 3; ++i)
        if (a.normal[i] != b.normal[i]) return a.normal[i] < b.normal[i];
    return true;
}

Vec3f between(const Vec3f& a, const Vec3f& b, double t) {
    return Vec3f(Vec3d(a) + (Vec3d(b) - Vec3d(a)) * t);
}

// Of a point `r` between a and b, with two components equal in magnitude: moves the third to where
// it must be, by a rounding error, if it is on another side of a plane than both a and b are.
void keep_on_side(Vec3d& r, const Vec3d& a, const Vec3d& b, int equal1, int equal2) {
    const int third = 3 - equal1 - equal2;
    for (const int i : {std::min(equal1, equal2), std::max(equal1, equal2)}) {
        for (const double side : {1.0, -1.0}) {
            const auto distance = [&](const Vec3d& v) { return v[i] - side * v[third]; };
            const double da = distance(a), db = distance(b), d = distance(r);
            if ((da >= 0 && db >= 0 && d < 0) || (da <= 0 && db <= 0 && d > 0))
                r[third] = side * r[i];
        }
    }
}

// \pre the ends lie strictly on either side
Corner crossing(const Corner& end1, const Corner& end2, const Plane& plane) {
    const bool sorted = in_order(end1, end2);
    const Corner& a = sorted ? end1 : end2;
    const Corner& b = sorted ? end2 : end1;
    const double da = plane.distance(a.r), db = plane.distance(b.r);
    // Equal only if the triangle's r is almost 0 there, and rounding decides about sides.
    const double t = da == db ? 0.5 : std::clamp(da / (da - db), 0.0, 1.0);

    Corner c{between(a.position, b.position, t), between(a.normal, b.normal, t),
             a.r + (b.r - a.r) * t, kNew};
    const double equal = (plane.sign * c.r[plane.axis] + plane.side * c.r[plane.other]) / 2;
    c.r[plane.axis] = plane.sign * equal;
    c.r[plane.other] = plane.side * equal;
    keep_on_side(c.r, a.r, b.r, plane.axis, plane.other);
    return c;
}

using Triangle = std::array<Corner, 3>;

// Where r is parallel to what two planes of a face have in common. With g along it, Cramer's rule
// gives the barycentric coordinates as det(g, r_j, r_k) over their sum.
Corner meeting(const Triangle& triangle, const Plane& p, const Plane& q) {
    Vec3d g(0);
    if (p.other ==
        q.other) {  // r[axis] = r[other] = 0; such a corner does not outlast the clipping
        g[3 - p.axis - p.other] = 1;
    } else {
        g[p.axis] = p.sign;
        g[p.other] = p.side;
        g[q.other] = q.side;
    }
    double weight[3], sum = 0;
    for (int i = 0; i < 3; ++i) {
        weight[i] = g.dot(triangle[(i + 1) % 3].r.cross(triangle[(i + 2) % 3].r));
        sum += weight[i];
    }
    double clamped = 0;
    for (double& w : weight) {
        w = sum == 0 ? 1.0 / 3 : std::clamp(w / sum, 0.0, 1.0);
        clamped += w;
    }
    Vec3d position(0), normal(0), r(0);
    for (int i = 0; i < 3; ++i) {
        const double w = weight[i] / clamped;
        position += Vec3d(triangle[i].position) * w;
        normal += Vec3d(triangle[i].normal) * w;
        r += triangle[i].r * w;
    }
    return {Vec3f(position), Vec3f(normal), g * (r.dot(g) / g.dot(g)), kNew};
}

// A convex polygon; each side, from a corner to the next, remembers the line on which it lies: an
// edge of the triangle (0 to 2), or kPlaneLines + a plane.
constexpr int kPlaneLines = 3;
struct Polygon {
    // Each plane adds at most one corner to a convex polygon. Rounding can make one look concave;
    // then half as many again, at most.
    static constexpr int kMost = 16;
    Corner corners[kMost];
    int lines[kMost];
    int count = 0;

    void add(const Corner& corner, int line) {
        if (count == kMost) return;
        corners[count] = corner;
        lines[count++] = line;
    }
};

Corner on_line(const Triangle& triangle, int line, const std::array<Plane, 4>& planes,
               const Plane& plane) {
    if (line < kPlaneLines) return crossing(triangle[line], triangle[(line + 1) % 3], plane);
    return meeting(triangle, planes[line - kPlaneLines], plane);
}

Polygon clip(const Polygon& polygon, const Triangle& triangle, const std::array<Plane, 4>& planes,
             int by) {
    double distances[Polygon::kMost];
    for (int i = 0; i < polygon.count; ++i)
        distances[i] = planes[by].distance(polygon.corners[i].r);

    Polygon result;
    for (int i = 0; i < polygon.count; ++i) {
        const double here = distances[i], next = distances[(i + 1) % polygon.count];
        const int line = polygon.lines[i];
        const bool leaves = here >= 0 && next < 0, enters = here < 0 && next > 0;
        if (here >= 0)
            result.add(polygon.corners[i], leaves && here == 0 ? kPlaneLines + by : line);
        if (leaves && here > 0)
            result.add(on_line(triangle, line, planes, planes[by]), kPlaneLines + by);
        if (enters) result.add(on_line(triangle, line, planes, planes[by]), line);
    }
    return result;
}

// A triangle whose r lie in a plane between two faces belongs to the first.
bool belongs_to_earlier_face(const Triangle& triangle, const std::array<Plane, 4>& planes) {
    return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
        return plane.other < plane.axis &&
               std::all_of(triangle.begin(), triangle.end(),
                           [&](const Corner& corner) { return plane.distance(corner.r) == 0; });
    });
}

// The part of the triangle that reflects into the face; none for most faces, and most planes around
// the others do not meet the triangle.
Polygon piece_on_face(const Triangle& triangle, int face) {
    const std::array<Plane, 4> planes = planes_of(face);
    bool meets[4];
    for (int i = 0; i < 4; ++i) {
        int outside = 0;
        for (const Corner& corner : triangle) outside += planes[i].distance(corner.r) < 0 ? 1 : 0;
        if (outside == 3) return {};
        meets[i] = outside > 0;
    }
    if (belongs_to_earlier_face(triangle, planes)) return {};

    Polygon polygon;
    for (int i = 0; i < 3; ++i) polygon.add(triangle[i], i);
    for (int by = 0; by < 4 && polygon.count > 0; ++by)
        if (meets[by]) polygon = clip(polygon, triangle, planes, by);
    return polygon;
}

// Bit f: r points to face f. On edges and corners several are set.
unsigned faces_of(const Vec3d& r) {
    const double most = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
    return (r.x == most ? 1u : 0) | (-r.x == most ? 2u : 0) | (r.y == most ? 4u : 0) |
           (-r.y == most ? 8u : 0) | (r.z == most ? 16u : 0) | (-r.z == most ? 32u : 0);
}

// From the eye's place v = 0; its reflection is taken as along n.
Vec3d reflected(const Vec3f& position, const Vec3f& normal, const Vec3d& eye) {
    const Vec3d n(normal), to_eye = eye - Vec3d(position);
    const double length = to_eye.length();
    const Vec3d v = length > 0 ? to_eye / length : n;
    return n * (2 * n.dot(v)) - v;
}

class Splitter {
  public:
    Splitter(const Mesh& mesh, const Vec3d& eye, const Axes& axes) : mesh_(mesh) {
        const std::size_t count = mesh.positions.size();
        r_.reserve(count);
        faces_.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            r_.push_back(axes.to_map(reflected(mesh.positions[i], mesh.normals[i], eye)));
            faces_.push_back(static_cast<std::uint8_t>(faces_of(r_.back())));
        }
        for (auto& copies : copies_) copies.assign(count, kNew);
        // Each vertex once, and some again beside the edges of faces.
        const std::size_t expected = count + count / 2;
        result_.positions.reserve(expected);
        result_.normals.reserve(expected);
        result_.texture_coordinates.reserve(expected);
    }

    SplitMesh split() && {
        for (std::size_t i = 0; i < mesh_.indices.size(); i += 3) {
            const std::uint32_t* corner = &mesh_.indices[i];
            const unsigned common = faces_[corner[0]] & faces_[corner[1]] & faces_[corner[2]];
            if (common != 0)
                add_whole(corner, first_of(common));
            else
                add_pieces(corner);
        }
        return std::move(result_);
    }

  private:
    static int first_of(unsigned faces) {
        int face = 0;
        while ((faces >> face & 1u) == 0) ++face;
        return face;
    }

    void add_whole(const std::uint32_t* corner, int face) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t i = corner[k];
            std::uint32_t& copy = copies_[face][i];
            if (copy == kNew) copy = add_vertex(mesh_.positions[i], mesh_.normals[i], r_[i], face);
            result_.indices[face].push_back(copy);
        }
    }

    void add_pieces(const std::uint32_t* corner) {
        Triangle triangle;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t i = corner[k];
            triangle[k] = {mesh_.positions[i], mesh_.normals[i], r_[i], i};
        }
        for (int face = 0; face < kFaces; ++face) add_fan(piece_on_face(triangle, face), face);
    }

    void add_fan(const Polygon& polygon, int face) {
        std::uint32_t vertices[Polygon::kMost];
        int count = 0;
        for (int i = 0; i < polygon.count; ++i) {
            const Vec3f& position = polygon.corners[i].position;
            const bool repeats = position == polygon.corners[(i + 1) % polygon.count].position;
            if (!repeats) vertices[count++] = static_cast<std::uint32_t>(i);
        }
        if (count < 3) return;
        for (int i = 0; i < count; ++i) vertices[i] = vertex_of(polygon.corners[vertices[i]], face);
        for (int i = 2; i < count; ++i)
            result_.indices[face].insert(result_.indices[face].end(),
                                         {vertices[0], vertices[i - 1], vertices[i]});
    }

    std::uint32_t vertex_of(const Corner& corner, int face) {
        if (corner.index == kNew) return add_vertex(corner.position, corner.normal, corner.r, face);
        std::uint32_t& copy = copies_[face][corner.index];
        if (copy == kNew) copy = add_vertex(corner.position, corner.normal, corner.r, face);
        return copy;
    }

    std::uint32_t add_vertex(const Vec3f& position, const Vec3f& normal, const Vec3d& r, int face) {
        // q vanishes only where r passes through 0; there any texel is as right as another.
        constexpr double kLeastQ = 1e-30;
        Vec3d stq = Cube::homogeneous(face, r);
        if (stq.z < kLeastQ) stq = {kLeastQ / 2, kLeastQ / 2, kLeastQ};
        result_.positions.push_back(position);
        result_.normals.push_back(normal);
        result_.texture_coordinates.emplace_back(stq);
        return static_cast<std::uint32_t>(result_.positions.size() - 1);
    }

    const Mesh& mesh_;
    std::vector<Vec3d> r_;             // of the cube's frame, one per vertex
    std::vector<std::uint8_t> faces_;  // faces_of() each
    std::vector<std::uint32_t> copies_[kFaces];
    SplitMesh result_;
};

}  // namespace

SplitMesh split_by_cube_face(const Mesh& world_mesh, const Vec3d& eye, const Axes& cube_axes) {
    return Splitter(world_mesh, eye, cube_axes).split();
}

}  // namespace mirrorball
