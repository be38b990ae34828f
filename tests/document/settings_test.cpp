#include "engine/document/settings.h"

#include <gtest/gtest.h>

#include "tests/document/toy_method.h"

namespace sinew::document {

namespace {

std::string message_of(const Layer& layer) {
  const Method methods[] = {toy_method()};
  try {
    check_layers(std::span(&layer, 1), methods);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

Layer toy_layer(std::vector<SettingEdit> settings = {}) {
  Layer layer;
  layer.method = "toy";
  layer.settings = std::move(settings);
  layer.place.text = "e.json:1:2";
  return layer;
}

}  // namespace

TEST(Settings, NamesRangesAndChoicesAreChecked) {
  const Place place{"e.json:3:4"};
  EXPECT_EQ(message_of(toy_layer({{"count", 3.0, place}, {"style", "square", place}})), "no error");
  EXPECT_EQ(message_of(toy_layer({{"cuont", 3.0, place}})),
            "e.json:3:4: expected a setting of method toy, one of \"pause\", \"count\", \"style\", found \"cuont\"");
  EXPECT_EQ(message_of(toy_layer({{"count", 0.0, place}})),
            "e.json:3:4: expected a whole number from 1 to 10 for \"count\", found 0");
  EXPECT_EQ(message_of(toy_layer({{"count", 1.5, place}})),
            "e.json:3:4: expected a whole number from 1 to 10 for \"count\", found 1.5");
  EXPECT_EQ(message_of(toy_layer({{"pause", "long", place}})),
            "e.json:3:4: expected a number from 0 to 1 for \"pause\", found \"long\"");
  EXPECT_EQ(message_of(toy_layer({{"style", "oval", place}})),
            "e.json:3:4: expected one of \"round\", \"square\" for \"style\", found \"oval\"");
  EXPECT_EQ(message_of(toy_layer({{"style", 1.0, place}})),
            "e.json:3:4: expected one of \"round\", \"square\" for \"style\", found 1");
}

TEST(Settings, AChoiceBecomesItsIndex) {
  const Settings settings = settings_of(toy_layer({{"style", "square", {}}}), toy_method());
  EXPECT_EQ(settings, (Settings{{"style", 1}}));
}

TEST(Settings, WhatNoMethodKnowsYetIsRefusedNotIgnored) {
  Layer layer = toy_layer();
  layer.method = "tet";
  EXPECT_EQ(message_of(layer), "e.json:1:2: expected a method, one of \"toy\", found \"tet\"");
  layer.on = false;
  EXPECT_EQ(message_of(layer), "no error");
  layer = toy_layer();
  layer.rigid.resize(2);
  EXPECT_EQ(message_of(layer), "e.json:1:2: expected no \"rigid\" for method toy, found 2");
  layer = toy_layer();
  layer.stiffness.resize(1);
  EXPECT_EQ(message_of(layer), "e.json:1:2: expected no \"stiffness\" for method toy, found 1");
  layer = toy_layer();
  layer.examples = {"a.obj"};
  EXPECT_EQ(message_of(layer), "e.json:1:2: expected no \"examples\" for method toy, found 1");
  layer = toy_layer();
  layer.cuts.resize(3);
  EXPECT_EQ(message_of(layer), "e.json:1:2: expected no \"cuts\" for method toy, found 3");
  layer = toy_layer();
  layer.path.emplace();
  EXPECT_EQ(message_of(layer), "e.json:1:2: expected no \"path\" for method toy, found 1");
  layer = toy_layer();
  layer.nodes.resize(2);
  EXPECT_EQ(message_of(layer), "e.json:1:2: expected no \"nodes\" for method toy, found 2");
}

TEST(Settings, FromTheCommandLine) {
  const Method methods[] = {toy_method()};
  Project project;
  project.layers = {toy_layer(), toy_layer({{"count", 3.0, {}}})};
  set_from_text("count=7", project, methods);
  set_from_text("2.style=square", project, methods);
  EXPECT_EQ(project.layers[0].settings, (std::vector<SettingEdit>{{"count", 7.0, {}}}));
  EXPECT_EQ(project.layers[1].settings, (std::vector<SettingEdit>{{"count", 7.0, {}}, {"style", "square", {}}}));
  EXPECT_THROW(set_from_text("count", project, methods), InputError);
  EXPECT_THROW(set_from_text("cuont=1", project, methods), InputError);
  EXPECT_THROW(set_from_text("3.count=1", project, methods), InputError);
}

}  // namespace sinew::document
