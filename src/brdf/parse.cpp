// BRDFs from text: models, presets and sums of them.
#include <algorithm>
#include <cctype>
#include <functional>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <mirrorball/brdf.h>
#include <mirrorball/error.h>

#include "brdf/model.h"
#include "brdf/parameters.h"
#include "brdf/sum.h"
#include "io/file.h"

namespace mirrorball {
namespace detail {
namespace {

// A model by its name: how it is made of its defaults and texts that change them, one after the
// other.
struct Family {
    std::string name, parameters, description;
    std::function<ModelPointer(const std::vector<std::string_view>&)> make;
};

template <class P>
Family family(P defaults, const char* description) {
    ParameterLister lister;
    visit(defaults, lister);
    return {std::string(model_name(defaults)), lister.text(), description,
            [defaults](const std::vector<std::string_view>& texts) {
                P parameters = defaults;
                for (const std::string_view text : texts) {
                    ParameterReader reader(text);
                    visit(parameters, reader);
                    reader.finish();
                }
                return make_model(parameters);
            }};
}

const std::vector<Family>& families() {
    static const std::vector<Family> all = {
        family(Lambert{}, "ideally diffuse"),
        family(OrenNayar{}, "rough and diffuse; sigma in degrees"),
        family(Phong{}, "a lobe about the mirror direction, normalised"),
        family(Phong{.form = Phong::Form::plain}, "the same, without its normalisation"),
        family(Phong{.form = Phong::Form::lewis}, "the survey's Eq. 18, divided by the cosine"),
        family(BlinnPhong{}, "a lobe of the half vector"),
        family(Lafortune{}, "a generalised cosine lobe; add two or three"),
        family(Ward{}, "slopes with a normal distribution, bounded albedo"),
        family(Ward{.form = Ward::Form::original}, "as Ward published it in 1992"),
        family(Banks{}, "fibres along the tangent"),
        family(Microfacet{.distribution = Microfacet::Distribution::beckmann},
               "Cook and Torrance's small mirrors, Beckmann's slopes"),
        family(Microfacet{}, "small mirrors with long tails; anisotropic by two roughnesses"),
        family(Sheen{}, "fibres that stand up: velvet"),
        family(Mirror{}, "an ideal mirror"),
        family(Plastic{}, "a glossy layer coupled with a diffuse base"),
    };
    return all;
}

struct Preset {
    const char *name, *text, *description;
};

constexpr Preset kPresets[] = {
    {"cook-torrance", "beckmann:roughness=0.4,index=1.5", "the model, by its authors' names"},
    {"ceramic", "plastic:reflectance=0.8/0.78/0.72,roughness=0.1,index=1.6", "glazed, off-white"},
    {"rubber", "plastic:reflectance=0.03,roughness=0.7,index=1.5", "black, matt"},
    {"car-paint", "plastic:reflectance=0.5/0.02/0.02,roughness=0,index=1.5",
     "red under clear coat"},
    {"clay", "oren-nayar:sigma=30,reflectance=0.55/0.35/0.25", "unglazed, flat as the full moon"},
    {"velvet", "0.25/0.02/0.05*lambert + 0.7/0.1/0.2*charlie:roughness=0.5", "crimson"},
    {"satin", "0.1/0.15/0.4*lambert + 0.3/0.35/0.5*banks:exponent=40", "blue, threads along x"},
    {"lacquered-copper", "ggx:roughness=0.2,metal=copper,coat=1.5", "a metal under varnish"},
    {"water", "mirror:index=1.333", "its surface"},
};

// "brushed-gold": finishes of metals, roughness across the brush marks being the larger.
struct Finish {
    const char *name, *parameters;
};
constexpr Finish kFinishes[] = {
    {"", "roughness=0.3"},
    {"polished-", "roughness=0.1"},
    {"satin-", "roughness=0.4"},
    {"rough-", "roughness=0.7"},
    {"brushed-", "roughness-x=0.25,roughness-y=0.6"},
};

std::optional<std::string> preset_text(std::string_view name) {
    for (const Preset& preset : kPresets) {
        if (preset.name == name) return preset.text;
    }
    for (const Finish& finish : kFinishes) {
        for (const Metal& metal : metals()) {
            if (name == fmt::format("{}{}", finish.name, metal.name))
                return fmt::format("ggx:{},metal={}", finish.parameters, metal.name);
        }
    }
    return std::nullopt;
}

// A name, and the parameters after its colon or comma.
struct Call {
    std::string name;
    std::string_view parameters;
};

Call split_call(std::string_view text) {
    const std::size_t end = std::min(text.find_first_of(":,"), text.size());
    std::string name(trimmed(text.substr(0, end)));
    std::replace(name.begin(), name.end(), ' ', '-');
    return {name, trimmed(text.substr(std::min(end + 1, text.size())))};
}

const Family* find_family(std::string_view name) {
    for (const Family& family : families()) {
        if (family.name == name) return &family;
    }
    return nullptr;
}

[[noreturn]] void report_unknown(const std::string& name) {
    std::vector<std::string> names;
    for (const Family& family : families()) names.push_back(family.name);
    for (const Preset& preset : kPresets) names.emplace_back(preset.name);
    throw Error(Errc::usage,
                fmt::format("no BRDF \"{}\"; there are {}, merl:FILE, table:FILE, and metals as "
                            "gold, polished-gold, satin-gold, rough-gold, brushed-gold",
                            name, fmt::join(names, ", ")));
}

bool names_file(std::string_view term) {
    return term.starts_with("merl:") || term.starts_with("table:");
}

std::vector<SumTerm> parse_sum(std::string_view text);

std::vector<SumTerm> parse_call(std::string_view text) {
    const Call call = split_call(text);
    if (names_file(text)) {
        if (call.parameters.empty())
            throw Error(Errc::usage, fmt::format("expected {}:FILE", call.name));
        InputFile file{std::filesystem::path(call.parameters)};
        return {{Vec3d(1), call.name == "merl" ? read_merl_model(file) : read_table_model(file)}};
    }
    if (const Family* family = find_family(call.name))
        return {{Vec3d(1), family->make({call.parameters})}};

    const std::optional<std::string> preset = preset_text(call.name);
    if (!preset) report_unknown(call.name);
    if (call.parameters.empty()) return parse_sum(*preset);
    const Call base = split_call(*preset);
    const Family* family = find_family(base.name);
    if (family == nullptr)
        throw Error(Errc::usage, fmt::format("{} is a sum and has no parameters", call.name));
    return {{Vec3d(1), family->make({base.parameters, call.parameters})}};
}

// "0.3*lambert": a star before any other than the characters of numbers.
std::vector<SumTerm> parse_term(std::string_view text) {
    const std::size_t star = text.find('*');
    const bool weighted =
        star != std::string_view::npos && text.find_first_not_of("0123456789./eE+- \t") == star;
    if (!weighted) return parse_call(trimmed(text));
    const Vec3d weight = parse_colour("weight", trimmed(text.substr(0, star)));
    std::vector<SumTerm> terms = parse_call(trimmed(text.substr(star + 1)));
    for (SumTerm& term : terms) term.weight *= weight;
    return terms;
}

// The plus that ends the term which `text` begins with: not that of "1e+5", nor one in a file's
// name that has no blank before it.
std::size_t find_plus(std::string_view text) {
    const std::size_t begin = text.find_first_not_of("0123456789./eE+-* \t");
    const bool file = begin != std::string_view::npos && names_file(text.substr(begin));
    for (std::size_t i = text.find('+'); i < text.size(); i = text.find('+', i + 1)) {
        const bool exponent =
            i >= 2 && (text[i - 1] == 'e' || text[i - 1] == 'E') &&
            (std::isdigit(static_cast<unsigned char>(text[i - 2])) != 0 || text[i - 2] == '.');
        const bool in_name = file && (i == 0 || text[i - 1] != ' ');
        if (!exponent && !in_name) return i;
    }
    return text.size();
}

std::vector<SumTerm> parse_sum(std::string_view text) {
    std::vector<SumTerm> terms;
    while (true) {
        const std::size_t plus = find_plus(text);
        const std::string_view term = trimmed(text.substr(0, plus));
        if (term.empty()) throw Error(Errc::usage, "a term is missing");
        for (SumTerm& part : parse_term(term)) terms.push_back(std::move(part));
        if (plus >= text.size()) return terms;
        text.remove_prefix(plus + 1);
    }
}

}  // namespace
}  // namespace detail

Brdf parse_brdf(std::string_view text) {
    try {
        return Brdf(detail::make_sum(detail::parse_sum(text)));
    } catch (const Error& error) {
        if (error.code() != Errc::usage) throw;
        throw Error(Errc::usage, fmt::format("BRDF \"{}\": {}", text, error.what()));
    }
}

std::vector<BrdfName> brdf_models() {
    std::vector<BrdfName> names;
    for (const detail::Family& family : detail::families())
        names.push_back({family.name, family.parameters, family.description});
    names.push_back({"merl", "FILE", "measured: a .binary file of the MERL database"});
    names.push_back({"table", "FILE", "measured: text, angles and values"});
    return names;
}

std::vector<BrdfName> brdf_presets() {
    std::vector<BrdfName> names;
    for (const auto& [name, text, description] : detail::kPresets)
        names.push_back({name, text, description});
    for (const detail::Finish& finish : detail::kFinishes) {
        for (const Metal& metal : metals())
            names.push_back({fmt::format("{}{}", finish.name, metal.name),
                             fmt::format("ggx:{},metal={}", finish.parameters, metal.name),
                             "a metal"});
    }
    return names;
}

}  // namespace mirrorball
