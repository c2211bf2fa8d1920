// BRDFs as text.
#include <gtest/gtest.h>
#include <mirrorball/brdf.h>
#include <mirrorball/error.h>

#include "brdf/brdf_support.h"

namespace mirrorball {
namespace {

TEST(BrdfText, RoundTrip) {
    std::vector<std::string> texts(std::begin(kReciprocalModels), std::end(kReciprocalModels));
    for (const BrdfName& name : brdf_models()) {
        if (name.parameters != "FILE") texts.push_back(name.name);
    }
    for (const BrdfName& name : brdf_presets()) texts.push_back(name.name);
    ASSERT_GT(texts.size(), 80u);
    for (const std::string& text : texts) {
        const Brdf brdf = parse_brdf(text), again = parse_brdf(to_string(brdf));
        EXPECT_EQ(to_string(again), to_string(brdf)) << text;
        const Vec3d wi = direction(30, 1), wo = direction(50, 4);
        EXPECT_EQ(again.evaluate(wi, wo), brdf.evaluate(wi, wo)) << text;
    }
}

TEST(BrdfText, SaysOneThingInSeveralWays) {
    const auto same = [](const char* a, const char* b) {
        EXPECT_EQ(to_string(parse_brdf(a)), to_string(parse_brdf(b)));
    };
    same("lambert:0.5", "lambert:reflectance=0.5/0.5/0.5");
    same("phong:100", " phong : exponent = 100 ");
    same("plastic, index 1.6", "plastic:index=1.6");
    same("brushed gold", "brushed-gold");
    same("brushed gold", "ggx:roughness-x=0.25,roughness-y=0.6,metal=gold");
    same("brushed gold, roughness-y 0.8", "ggx:roughness-x=0.25,roughness-y=0.8,metal=gold");
    same("gold, coat 1.5", "ggx:0.3,metal=gold,coat=1.5");
    same("lambert+mirror", "lambert + mirror");
    same("0.5*lambert + 5e-1*phong:1e+2", "0.5*lambert+0.5*phong:100");
    same("2 * velvet", "0.5/0.04/0.1*lambert + 1.4/0.2/0.4*charlie:0.5");
    same("ggx:0.3", "ggx:roughness-x=0.3,roughness-y=0.3");
}

TEST(BrdfText, MakesWhatTheStructsMake) {
    EXPECT_EQ(parse_brdf("phong:exponent=9,reflectance=0.1/0.2/0.3"),
              Brdf(Phong{.reflectance = {0.1, 0.2, 0.3}, .exponent = 9}));
    EXPECT_EQ(parse_brdf("beckmann:0.4,index=1.5"),
              Brdf(Microfacet{.distribution = Microfacet::Distribution::beckmann,
                              .roughness_x = 0.4,
                              .roughness_y = 0.4,
                              .fresnel = Fresnel::dielectric(1.5)}));
    EXPECT_EQ(parse_brdf("lafortune:5,kz=0.5"), Brdf(Lafortune{.k = {-1, -1, 0.5}, .exponent = 5}));
}

TEST(BrdfText, BadTextIsRefusedInWords) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "a term is missing"},
        {"lambert +", "a term is missing"},
        {"+ lambert", "a term is missing"},
        {"gld", "no BRDF \"gld\"; there are lambert"},
        {"ggx:roughness=1.5", "roughness is 1.5; expected a number from 0 to 1"},
        {"ggx:-0.1", "roughness is -0.1"},
        {"ggx:roughness-y=2", "roughness-y is 2"},
        {"ggx:roughness=nan", "roughness is nan"},
        {"ggx:roughness=rough", "roughness is \"rough\"; expected a number"},
        {"ggx:roughness=", "roughness is \"\"; expected a number"},
        {"ggx:0.1,0.2", "\"0.2\" is no parameter"},
        {"ggx:0.1,roughness=0.2", "no parameter \"0.1\""},
        {"ggx:roughness=0.1,roughness=0.2", "roughness is given twice"},
        {"ggx:0.1,,metal=gold", "missing between its commas"},
        {"ggx:0.1,shiny=1", "no parameter \"shiny\"; there are roughness, roughness-x"},
        {"ggx:metal=brass", "no metal \"brass\""},
        {"ggx:index=0", "index is 0; expected a number from 0.01 to 100"},
        {"mirror:index=-1", "index is -1"},
        {"phong:-1", "exponent is -1; expected a number from 0 to 1000000"},
        {"phong:inf", "exponent is inf"},
        {"blinn-phong:-1", "exponent is -1"},
        {"banks:-1", "exponent is -1"},
        {"ward:0", "roughness is 0; expected a number from 0.01 to 1"},
        {"charlie:0", "roughness is 0; expected a number from 0.01 to 1"},
        {"oren-nayar:100", "sigma is 100; expected a number from 0 to 90"},
        {"lambert:1.1", "reflectance is 1.1; expected a number from 0 to 1"},
        {"lambert:0.1/0.2", "expected one number or three"},
        {"lambert:0.1/0.2/x", "reflectance is \"x\""},
        {"lafortune:kx=0,ky=0,kz=0", "all 0"},
        {"lafortune:kx=nan", "kx is nan"},
        {"-1*lambert", "weight is -1; expected a number from 0 to 1000"},
        {"nan*lambert", "no BRDF \"nan*lambert\""},
        {"2000*lambert", "weight is 2000"},
        {"velvet, roughness 0.3", "velvet is a sum and has no parameters"},
        {"merl:", "expected merl:FILE"},
        {"table:", "expected table:FILE"},
    };
    for (const auto& [text, message] : cases) {
        try {
            (void)parse_brdf(text);
            ADD_FAILURE() << "accepted: " << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), Errc::usage) << text;
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    }
}

// Texts with a few characters changed, dropped or doubled are read or refused, nothing else.
TEST(BrdfText, AnyTextIsReadOrRefused) {
    const std::string texts[] = {"0.5*lambert:0.8 + 3e-1*phong:exponent=50,reflectance=0.1/0.2/0.3",
                                 "brushed gold, roughness-y 0.8, coat 1.5",
                                 "ggx:roughness-x=0.1,roughness-y=1e-1,n=0.2/0.9/1.1,k=3.9"};
    const std::string characters = "+*/:,= .0123456789eE-nax\t";
    Numbers numbers;
    const auto below = [&](std::size_t count) {
        return static_cast<std::size_t>(numbers.next() * static_cast<double>(count));
    };
    int read_count = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string text = texts[i % 3];
        for (std::size_t edits = 1 + below(3); edits > 0; --edits) {
            const std::size_t at = below(text.size());
            const char c = characters[below(characters.size())];
            const std::size_t kind = below(3);
            if (kind == 0)
                text[at] = c;
            else if (kind == 1)
                text.insert(at, 1, c);
            else
                text.erase(at, 1);
        }
        try {
            const Brdf brdf = parse_brdf(text);
            EXPECT_EQ(parse_brdf(to_string(brdf)), brdf) << text;
            ++read_count;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), Errc::usage) << text;
        }
    }
    EXPECT_GT(read_count, 100);
}

TEST(BrdfText, BadStructsAreRefusedToo) {
    EXPECT_THROW(Brdf(Lambert{Vec3d(2)}), Error);
    EXPECT_THROW(Brdf(OrenNayar{.sigma_degrees = -1}), Error);
    EXPECT_THROW(Brdf(Phong{.exponent = -1}), Error);
    EXPECT_THROW(Brdf(BlinnPhong{.exponent = std::nan("")}), Error);
    EXPECT_THROW(Brdf(Lafortune{.k = Vec3d(0)}), Error);
    EXPECT_THROW(Brdf(Ward{.roughness_x = 0}), Error);
    EXPECT_THROW(Brdf(Banks{.exponent = 1e7}), Error);
    EXPECT_THROW(Brdf(Microfacet{.roughness_x = 0.5, .roughness_y = 1.5}), Error);
    EXPECT_THROW(Brdf(Microfacet{.roughness_x = -1, .roughness_y = -1}), Error);
    EXPECT_THROW(Brdf(Microfacet{.roughness_x = std::nan(""), .roughness_y = 0.1}), Error);
    EXPECT_THROW(Brdf(Sheen{.roughness = 0}), Error);
    EXPECT_THROW(Brdf(Plastic{.roughness = 2}), Error);
}

}  // namespace
}  // namespace mirrorball
