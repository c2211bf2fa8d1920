// Complex indices of metals.
//
// Each is read off its source's table at 650, 550 and 450 nm by straight lines between the two
// points next to the wavelength, to three decimals. Three wavelengths are not a colour: an
// integral over the spectrum would shift hues a little, of gold and copper the most.
#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/fresnel.h>

namespace mirrorball {
namespace {

constexpr std::string_view kNobleMetals =
    "Johnson and Christy 1972, Optical Constants of the Noble Metals, Phys. Rev. B 6";
constexpr std::string_view kTransitionMetals =
    "Johnson and Christy 1974, Optical Constants of Transition Metals, Phys. Rev. B 9";
constexpr std::string_view kAluminium =
    "Rakic 1995, Algorithm for the Determination of Intrinsic Optical Constants of Metal Films: "
    "Application to Aluminum, Appl. Opt. 34";

const Metal kMetals[] = {
    {"gold", {0.156, 0.424, 1.383}, {3.602, 2.472, 1.915}, kNobleMetals},
    {"silver", {0.052, 0.060, 0.040}, {4.409, 3.597, 2.648}, kNobleMetals},
    {"copper", {0.238, 1.007, 1.240}, {3.626, 2.582, 2.393}, kNobleMetals},
    {"aluminium", {1.558, 1.015, 0.633}, {7.712, 6.627, 5.454}, kAluminium},
    {"iron", {2.911, 2.950, 2.584}, {3.089, 2.932, 2.767}, kTransitionMetals},
    {"titanium", {2.741, 2.542, 2.267}, {3.814, 3.435, 3.038}, kTransitionMetals},
    {"chromium", {3.107, 3.181, 2.323}, {3.331, 3.329, 3.135}, kTransitionMetals},
    {"nickel", {1.990, 1.921, 1.729}, {4.209, 3.616, 2.944}, kTransitionMetals},
};

}  // namespace

std::span<const Metal> metals() {
    return kMetals;
}

const Metal& metal(std::string_view name) {
    std::string names;
    for (const Metal& known : kMetals) {
        if (known.name == name) return known;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", known.name);
    }
    throw Error(Errc::usage, fmt::format("no metal \"{}\"; there are {}", name, names));
}

}  // namespace mirrorball
