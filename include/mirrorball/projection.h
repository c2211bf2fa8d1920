// Projections: every way in which a sphere of directions is laid out on flat images.
//
// A projection maps a direction d in the map's frame (axes.h) to a point on one of its faces and
// back. Each is a type with the same static members, all pure and inline, so that loops over texels
// are compiled once per projection and never branch on it; `visit` picks the type for a run-time
// value.
//
//     name, face_count, aspect     what it is called; images; width / height of one
//     fills_square                 is every point of a face used? (else: those in the inscribed
//     disc) three_at_corners             do three faces meet at a face's corners, so that no texel
//     lies
//                                  diagonally beyond them?
//     project(d)                   direction (any length but 0) -> face point
//     direction(p)                 face point -> unit direction; defined on the whole square, also
//                                  outside the used part (see wrap)
//     tangents(p, d)               d direction / ds and / dt at p, where d = direction(p); analytic
//     density(p)                   |ds x dt|: steradians per unit area of the face
//     covers(p)                    is this point in the used part of the face?
//     wrap(p)                      a point up to half a face outside the used part -> the same
//     place
//                                  of the sphere, reached by walking straight across the edge
//     solid_angle(face, rect)      exact steradians of a rectangle's used part
//     seam_count, pole_count       edges along which neighbours on the sphere are apart on the
//                                  picture; places where an edge or a whole rim is one direction
//
// To add one: write include/mirrorball/projections/NAME.h by the example of its neighbours, add the
// type to `Projections` below and its name to the enumeration. The tests in
// tests/projection/projection_test.cpp take the list and prove its laws.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <mirrorball/axes.h>
#include <mirrorball/projections/angular.h>
#include <mirrorball/projections/cube.h>
#include <mirrorball/projections/dual_paraboloid.h>
#include <mirrorball/projections/equal_area_octahedral.h>
#include <mirrorball/projections/equirect.h>
#include <mirrorball/projections/octahedral.h>
#include <mirrorball/projections/sphere.h>

namespace mirrorball {

/// In the order of `Projections`.
enum class Projection {
    equirect,
    cube,
    sphere,
    dual_paraboloid,
    angular,
    octahedral,
    equal_area_octahedral,
};

using Projections = std::tuple<Equirect, Cube, SphereMap, DualParaboloid, AngularMap, Octahedral,
                               EqualAreaOctahedral>;
inline constexpr std::size_t kProjectionCount = std::tuple_size_v<Projections>;

/// Calls f(Equirect{}), f(Cube{}), ... for the projection's type and returns what it returns.
template <class F>
decltype(auto) visit(Projection projection, F&& f);

[[nodiscard]] std::string_view name(Projection projection);
/// \throws Error(Errc::usage) naming the projections there are
[[nodiscard]] Projection parse_projection(std::string_view name);
[[nodiscard]] int face_count(Projection projection);
/// Width / height of one face: 2 for equirect, 1 for all others.
[[nodiscard]] int aspect(Projection projection);

/// Exact steradians of each texel's used part, in rows from the top: width x height values.
/// All faces of a projection have the same table. Zero marks an unused texel.
[[nodiscard]] std::vector<double> solid_angle_table(Projection projection, int width, int height);

/// The facts by which the survey's section 3 compares parameterisations, measured over the texels
/// of a map whose faces have `size` rows.
struct ProjectionFacts {
    double used_share;         ///< of the pixels, by area
    double solid_angle_ratio;  ///< largest : smallest solid angle of a wholly used texel
    double worst_stretch;      ///< longest : shortest axis of a texel's footprint, at texel centres
    double pixels_per_degree;  ///< pixels needed so that nowhere are two texels over 1 degree apart
    int seam_count;            ///< see above
    int pole_count;
};
[[nodiscard]] ProjectionFacts measure(Projection projection, int size = 512);

// ---------------------------------------------------------------------------------------------------

namespace detail {

template <class F, std::size_t... I>
decltype(auto) visit_projection(std::size_t index, F&& f, std::index_sequence<I...>) {
    using Result = decltype(f(std::tuple_element_t<0, Projections>{}));
    using Call = Result (*)(F&);
    static constexpr Call calls[] = {
        +[](F& g) -> Result { return g(std::tuple_element_t<I, Projections>{}); }...};
    return calls[index](f);
}

}  // namespace detail

template <class F>
decltype(auto) visit(Projection projection, F&& f) {
    return detail::visit_projection(static_cast<std::size_t>(projection), std::forward<F>(f),
                                    std::make_index_sequence<kProjectionCount>{});
}

}  // namespace mirrorball
