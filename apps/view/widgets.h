// SPDX-License-Identifier: MIT
// Rows of the panel: a name on the left, a widget on the right, a sentence as its tip. Each notes its place (panel.h) under its
// key. All give whether the value was changed.
#pragma once

#include "base/param.h"

#include <span>
#include <string>
#include <string_view>

namespace gn {

/// A heading that folds what stands under it; whether that is open.
bool section(const char* title, bool open);
bool slider_row(const char* key, const char* name, float& value, float low, float high, const char* format,
                const char* tip, bool logarithmic = false);
bool slider_row(const char* key, const char* name, int& value, int low, int high, const char* format, const char* tip);
bool check_row(const char* key, const char* name, bool& value, const char* tip);
/// One of `choices`; `value` becomes it.
bool choice_row(const char* key, const char* name, std::string& value, std::span<const std::string> choices,
                const char* tip);
/// A field of text; true once Enter ends it.
bool text_row(const char* key, const char* name, std::string& value, const char* tip);
/// A row that only tells.
void told_row(const char* name, const std::string& value, const char* tip = "");
/// A bar as long as a share of 1, with a name and a figure on it.
void bar(const std::string& name, const std::string& figure, float share, bool warm);
bool button(const char* key, const char* name, const char* tip);
void sentence(const std::string& text, bool warn);

/// The widget of a parameter: `value` as text, as recipes write it.
bool parameter_row(const std::string& key, const ParamRow& row, std::string& value);

}  // namespace gn
