// Pages: what all of them share.
#pragma once

#include <string>
#include <string_view>

namespace mirrorball::cli {

/// For text within HTML, SVG and their attributes.
[[nodiscard]] std::string escaped(std::string_view text);

/// A whole page that needs no network and no other style: `top` above the main part, `main` in it.
/// `title` is plain text, the other two are HTML.
[[nodiscard]] std::string html_page(std::string_view title, std::string_view top,
                                    std::string_view main);

/// The name of a thing and its value, in a list of class "facts".
[[nodiscard]] std::string html_fact(std::string_view name, std::string_view value);

}  // namespace mirrorball::cli
