#include <fmt/format.h>

#include "html.h"
#include "method_comparison.h"

namespace mirrorball::cli {
namespace {

std::string picture(const std::string& file, const std::string& alt) {
    return fmt::format("<img src=\"{}\" alt=\"{}\" loading=\"lazy\">", file, escaped(alt));
}

std::string milliseconds(double seconds) {
    return fmt::format("{:.1f} ms", seconds * 1e3);
}

std::string card(const MethodResult& result, double constant_seconds) {
    const std::string name(mirrorball::name(result.method));
    return fmt::format(
        "<figure class=\"card\"><div class=\"well pair\">{}{}</div><figcaption><h3>{}</h3>"
        "<p>{}</p><dl class=\"facts\">{}{}{}{}{}</dl></figcaption></figure>\n",
        picture(name + ".png", "Drawn by the method " + name),
        picture(name + "-error.png", "Its error in false colours"), name,
        escaped(describe(result.method)),
        html_fact("Error, mean", fmt::format("{:.2f}", result.mean_error)),
        html_fact("Error, 99th percentile", fmt::format("{:.1f}", result.percentile_99)),
        html_fact("Error, largest", fmt::format("{:.0f}", result.largest_error)),
        html_fact("Maps", bytes_text(result.map_bytes)),
        html_fact("A frame", fmt::format("{}, {:.2f} times the constant colour",
                                         milliseconds(result.frame_seconds),
                                         result.frame_seconds / constant_seconds)));
}

}  // namespace

std::string methods_page(const MethodComparison& comparison, const std::string& driver,
                         const SceneInput& input) {
    const std::string subject = !input.file.empty()  ? input.file
                                : input.mesh.empty() ? "teapot"
                                                     : input.mesh;
    const std::string top = fmt::format(
        "<header class=\"title\"><h1>{} by every method</h1><p class=\"lead\">{} x {} pixels, "
        "{} of them show an object. Drawn by {}.</p></header>\n",
        escaped(subject), comparison.truth.width(), comparison.truth.height(),
        comparison.pixel_count, escaped(driver));
    std::string main = fmt::format(
        "<section><h2>The truth</h2><p>Each pixel's surface evaluated by the equations in double "
        "precision, its reflection looked up in the environment itself.</p>"
        "<figure class=\"card\" style=\"grid-row:auto\">{}</figure></section>\n"
        "<section><h2>The methods</h2><p>Each is drawn as its definition has it. Errors are next "
        "to the truth, in steps of 255 of what a screen shows, the mean of the three channels, "
        "over pixels that lie wholly on an object; in the picture beside, black is none and white "
        "is {:.0f} steps or more. Drawing the same objects in a constant colour takes "
        "{}.</p><div class=\"grid two\">\n",
        picture("truth.png", "The scene evaluated directly"), kErrorShownWhite,
        milliseconds(comparison.constant_seconds));
    for (const MethodResult& result : comparison.results)
        main += card(result, comparison.constant_seconds);
    main += "</div></section>\n<footer>Made by mirrorball " MIRRORBALL_VERSION ".</footer>\n";
    return html_page(subject + " by every method", top, main);
}

}  // namespace mirrorball::cli
