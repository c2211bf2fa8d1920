// Cube map: six square faces, +X -X +Y -Y +Z -Z, the OpenGL, Vulkan and Direct3D layout. Greene
// 1986.
//
//     face   s along   t along   major axis m       the survey's Eq. 3 and Table 1, mended:
//     +X     -z        -y        +x                     s = (sc / |m| + 1) / 2
//     -X     +z        -y        -x                     t = (tc / |m| + 1) / 2
//     +Y     +x        +z        +y
//     -Y     +x        -z        -y
//     +Z     +x        -y        +z
//     -Z     -x        -y        -z
//
//     dw = 4 (1 + a^2 + b^2)^(-3/2) ds dt,  a = 2s - 1, b = 2t - 1
//
// The frame is the cube's own: left-handed when the faces are pictures seen from inside. A map's
// axes (axes.h) say how it lies in the world.
#pragma once

#include <cmath>

#include <mirrorball/projections/face_point.h>

namespace mirrorball {

struct Cube {
    static constexpr const char* name = "cube";
    static constexpr int face_count = 6;
    static constexpr int aspect = 1;
    static constexpr bool fills_square = true;
    static constexpr bool three_at_corners = true;
    static constexpr int seam_count = 12;
    static constexpr int pole_count = 0;

    /// A direction exactly on an edge or corner belongs to the first of x, y, z that is largest.
    template <class T>
    static FacePoint<T> project(const Vec3<T>& d) {
        const T ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
        if (ax >= ay && ax >= az)
            return d.x >= 0 ? point(0, -d.z, -d.y, ax) : point(1, d.z, -d.y, ax);
        if (ay >= az) return d.y >= 0 ? point(2, d.x, d.z, ay) : point(3, d.x, -d.z, ay);
        return d.z >= 0 ? point(4, d.x, -d.y, az) : point(5, -d.x, -d.y, az);
    }

    /// (s q, t q, q) on a face that need not be the one that d points to: linear in d, and where
    /// q > 0 their quotients are the point of the face's plane that d points to.
    template <class T>
    static Vec3<T> homogeneous(int face, const Vec3<T>& d) {
        const FaceAxes& f = kFaceAxes[face];
        const T q = T(f.m[0]) * d.x + T(f.m[1]) * d.y + T(f.m[2]) * d.z;
        const T a = T(f.a[0]) * d.x + T(f.a[1]) * d.y + T(f.a[2]) * d.z;
        const T b = T(f.b[0]) * d.x + T(f.b[1]) * d.y + T(f.b[2]) * d.z;
        return {(a + q) / 2, (b + q) / 2, q};
    }

    template <class T>
    static Vec3<T> direction(const FacePoint<T>& p) {
        const Vec3<T> d = on_cube(p.face, 2 * p.s - 1, 2 * p.t - 1, T(1));
        return d / std::sqrt(d.dot(d));
    }

    template <class T>
    static Tangents<T> tangents(const FacePoint<T>& p, const Vec3<T>& /*d*/) {
        const T a = 2 * p.s - 1, b = 2 * p.t - 1;
        const Vec3<T> d = on_cube(p.face, a, b, T(1));
        const T length2 = d.dot(d), length = std::sqrt(length2);
        // d(u / |u|) = (du - u (u.du) / |u|^2) / |u|, and u.du is a da + b db
        const Vec3<T> along_s = on_cube(p.face, T(1), T(0), T(0));
        const Vec3<T> along_t = on_cube(p.face, T(0), T(1), T(0));
        return {(along_s - d * (a / length2)) * (2 / length),
                (along_t - d * (b / length2)) * (2 / length)};
    }

    static double density(const FacePoint<double>& p) {
        const double a = 2 * p.s - 1, b = 2 * p.t - 1;
        const double length2 = 1 + a * a + b * b;
        return 4 / (length2 * std::sqrt(length2));
    }

    template <class T>
    static bool covers(const FacePoint<T>& p) {
        return p.s >= 0 && p.s <= 1 && p.t >= 0 && p.t <= 1;
    }

    /// Folds what reaches over an edge down onto the next face, so that texels there line up with
    /// texels here. Beyond a corner, where three faces meet and there is no fourth, t is held
    /// first.
    template <class T>
    static FacePoint<T> wrap(const FacePoint<T>& p) {
        T a = 2 * p.s - 1, b = 2 * p.t - 1, m = 1;
        if (std::abs(a) > 1) {
            b = std::fmin(std::fmax(b, T(-1)), T(1));
            m = 2 - std::abs(a);
            a = std::copysign(T(1), a);
        } else if (std::abs(b) > 1) {
            m = 2 - std::abs(b);
            b = std::copysign(T(1), b);
        } else {
            return p;
        }
        return project(on_cube(p.face, a, b, m));
    }

    static double solid_angle(int /*face*/, const FaceRect& r) {
        const double a0 = 2 * r.s0 - 1, a1 = 2 * r.s1 - 1, b0 = 2 * r.t0 - 1, b1 = 2 * r.t1 - 1;
        return corner(a0, b0) - corner(a0, b1) - corner(a1, b0) + corner(a1, b1);
    }

  private:
    template <class T>
    static FacePoint<T> point(int face, T sc, T tc, T m) {
        return {face, (sc / m + 1) / 2, (tc / m + 1) / 2};
    }

    // The inverse of the table above, for the point (a, b) of the face at distance m. As a sum over
    // the face's axes, not a switch, so that loops along a face become vector code.
    template <class T>
    static Vec3<T> on_cube(int face, T a, T b, T m) {
        const FaceAxes& f = kFaceAxes[face];
        return {T(f.m[0]) * m + T(f.a[0]) * a + T(f.b[0]) * b,
                T(f.m[1]) * m + T(f.a[1]) * a + T(f.b[1]) * b,
                T(f.m[2]) * m + T(f.a[2]) * a + T(f.b[2]) * b};
    }

    struct FaceAxes {
        double m[3], a[3], b[3];
    };
    static constexpr FaceAxes kFaceAxes[6] = {
        {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
        {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
    };

    // Signed solid angle of the rectangle from a face's centre to (a, b).
    static double corner(double a, double b) {
        return std::atan2(a * b, std::sqrt(a * a + b * b + 1));
    }
};

}  // namespace mirrorball
