#include "brdf_text.h"

namespace mirrorball::cli {

Brdf read_brdf(const std::string& text) {
    const bool names_model = text.find(':') != std::string::npos;
    if (!names_model && text.ends_with(".binary")) return read_merl(text);
    if (!names_model && text.ends_with(".txt")) return read_brdf_table(text);
    return parse_brdf(text);
}

Choices brdf_choices() {
    Choices choices{.values = {}, .files = true};
    for (const BrdfName& name : brdf_models())
        choices.values.push_back(name.parameters == "FILE" ? name.name + ":" : name.name);
    for (const BrdfName& name : brdf_presets()) choices.values.push_back(name.name);
    return choices;
}

}  // namespace mirrorball::cli
