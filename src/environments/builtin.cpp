// The list of built-in environments: the one place that a new one is added to.
#include <mirrorball/builtin.h>

#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mirrorball/error.h>

#include "environment.h"
#include "rasterise.h"

namespace mirrorball {
namespace {

struct Entry {
    const char* name;
    const char* description;
    std::unique_ptr<detail::Environment> (*make)();
};

constexpr std::array kEntries{
    Entry{"sunset", "the sun low over a calm sea, with clouds", detail::make_sunset},
    Entry{"noon", "a high sun over hills and grassland, under small clouds", detail::make_noon},
    Entry{"studio", "softboxes in a dark photographic studio, contrast over 10 000 : 1",
          detail::make_studio},
    Entry{"axes", "each direction coloured and labelled, with an arrow for up: shows orientation",
          detail::make_axes_chart},
    Entry{"grid", "latitude and longitude in degrees: shows distortion", detail::make_grid},
    Entry{"white", "radiance 1 everywhere: shows lost or made-up energy", detail::make_white},
};

}  // namespace

std::vector<Builtin> builtins() {
    std::vector<Builtin> list;
    for (const Entry& entry : kEntries) list.push_back({entry.name, entry.description});
    return list;
}

EnvironmentMap make_builtin(std::string_view name, Projection projection, int size,
                            const Axes& axes, const Progress& progress) {
    for (const Entry& entry : kEntries)
        if (name == entry.name)
            return detail::rasterise(*entry.make(), projection, size, axes, progress);

    std::vector<std::string_view> names;
    for (const Entry& entry : kEntries) names.emplace_back(entry.name);
    throw Error(Errc::usage, fmt::format("builtin:{}: no such environment; there are {}", name,
                                         fmt::join(names, ", ")));
}

}  // namespace mirrorball
