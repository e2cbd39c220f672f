#include "bench/bar_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace relief::bench {

namespace {

// Pixels.
constexpr double kWidth = 1120, kPlotTop = 92, kPlotHeight = 300, kLeft = 64, kGap = 62, kRight = 16;
constexpr double kLabelHeight = 112, kNoteHeight = 17;

/// Told apart by those who see few colours (Okabe and Ito 2008).
constexpr std::array<const char*, 8> kColors = {"#0072b2", "#e69f00", "#d55e00", "#009e73",
                                                "#cc79a7", "#56b4e9", "#f0e442", "#999999"};

std::string escape(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

double sum_values(const Bar& bar) { return std::accumulate(bar.values.begin(), bar.values.end(), 0.0); }

/// 1, 2 or 5 times a power of ten, so that `highest` has three to seven steps.
double choose_step(double highest) {
    const double power = std::pow(10.0, std::floor(std::log10(highest)));
    const double digit = highest / power;
    return power * (digit < 1.5 ? 0.2 : digit < 3 ? 0.5 : digit < 7 ? 1 : 2);
}

/// The height of a value and the ticks beside it, for the bars of one or more panels.
class Axis {
  public:
    Axis(const std::vector<Panel>& panels, Scale scale) : scale_(scale) {
        double lowest = 0, highest = 0;
        for (const Panel& panel : panels)
            for (const Bar& bar : panel.bars) {
                const double sum = sum_values(bar);
                if (sum > 0) lowest = lowest > 0 ? std::min(lowest, sum) : sum;
                highest = std::max({highest, sum, bar.highest});
            }
        if (highest <= 0) lowest = highest = 1;
        if (scale == Scale::linear)
            choose_linear(highest);
        else
            choose_logarithmic(lowest, highest);
    }

    /// Pixels above the base line.
    double height(double value) const {
        if (value <= low_) return 0;
        return scale_ == Scale::linear ? kPlotHeight * value / high_
                                       : kPlotHeight * std::log10(value / low_) / std::log10(high_ / low_);
    }
    const std::vector<double>& ticks() const { return ticks_; }

  private:
    void choose_linear(double highest) {
        const double step = choose_step(highest * 1.08);
        high_ = highest * 1.08;
        for (int k = 0; k * step <= high_; ++k) ticks_.push_back(k * step);
    }

    void choose_logarithmic(double lowest, double highest) {
        low_ = std::pow(10.0, std::floor(std::log10(lowest)));
        high_ = std::pow(10.0, std::ceil(std::log10(highest * 1.5)));
        for (double tick = low_; tick <= high_ * 1.01; tick *= 10) ticks_.push_back(tick);
    }

    Scale scale_;
    double low_ = 0, high_ = 1;
    std::vector<double> ticks_;
};

class ChartWriter {
  public:
    explicit ChartWriter(const Chart& chart) : chart_(chart) {}

    std::string write() {
        const double height =
            kPlotTop + kPlotHeight + kLabelHeight + kNoteHeight * double(chart_.notes.size()) + 10;
        add("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" "
            "viewBox=\"0 0 {0:g} {1:g}\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n",
            kWidth, height);
        add("<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
        add("<text x=\"16\" y=\"26\" font-size=\"17\" font-weight=\"bold\">{}</text>\n",
            escape(chart_.title));
        write_legend();
        write_panels();
        for (size_t k = 0; k < chart_.notes.size(); ++k)
            add("<text x=\"16\" y=\"{:g}\" font-size=\"11\" fill=\"#555\">{}</text>\n",
                kPlotTop + kPlotHeight + kLabelHeight + kNoteHeight * double(k), escape(chart_.notes[k]));
        return text_ + "</svg>\n";
    }

  private:
    template <class... Values> void add(fmt::format_string<Values...> format, Values&&... values) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
    }

    void write_legend() {
        double x = 16;
        for (size_t k = 0; k < chart_.series.size(); ++k) {
            add("<rect x=\"{:g}\" y=\"38\" width=\"12\" height=\"12\" fill=\"{}\"/>\n", x, kColors.at(k));
            add("<text x=\"{:g}\" y=\"48\">{}</text>\n", x + 17, escape(chart_.series[k]));
            x += 40 + 6.6 * double(chart_.series[k].size());
        }
        add("<text x=\"16\" y=\"{:g}\" fill=\"#555\">{}</text>\n", kPlotTop - 22, escape(chart_.axis));
    }

    /// Panels get room by the number of their bars.
    void write_panels() {
        size_t bars = 0;
        for (const Panel& panel : chart_.panels) bars += panel.bars.size();
        if (bars == 0) return;
        const double room = kWidth - kLeft - kRight - kGap * double(chart_.panels.size() - 1);
        double x = kLeft;
        for (const Panel& panel : chart_.panels) {
            const double width = room * double(panel.bars.size()) / double(bars);
            write_panel(panel, x, width);
            x += width + kGap;
        }
    }

    void write_panel(const Panel& panel, double x, double width) {
        const double base = kPlotTop + kPlotHeight;
        const bool is_shared = chart_.scale == Scale::logarithmic;
        const Axis axis(is_shared ? chart_.panels : std::vector<Panel>{panel}, chart_.scale);
        for (const double tick : axis.ticks()) {
            const double y = base - axis.height(tick);
            add("<line x1=\"{:g}\" y1=\"{:.1f}\" x2=\"{:g}\" y2=\"{:.1f}\" stroke=\"#ddd\"/>\n", x, y,
                x + width, y);
            add("<text x=\"{:g}\" y=\"{:.1f}\" text-anchor=\"end\" font-size=\"11\">{}</text>\n", x - 5,
                y + 4, format_value(chart_.unit, tick));
        }
        const double pitch = width / double(std::max<size_t>(1, panel.bars.size()));
        for (size_t k = 0; k < panel.bars.size(); ++k)
            write_bar(panel.bars[k], axis, x + pitch * (double(k) + 0.5), std::min(0.66 * pitch, 60.0));
        add("<line x1=\"{:g}\" y1=\"{:g}\" x2=\"{:g}\" y2=\"{:g}\" stroke=\"#222\"/>\n", x, base, x + width,
            base);
        add("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\" font-weight=\"bold\">{}</text>\n",
            x + width / 2, base + kLabelHeight - 34, escape(panel.title));
        add("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\" font-size=\"11\">{}</text>\n", x + width / 2,
            base + kLabelHeight - 19, escape(panel.subtitle));
    }

    void write_bar(const Bar& bar, const Axis& axis, double center, double width) {
        const double base = kPlotTop + kPlotHeight;
        double sum = 0;
        for (size_t k = 0; k < bar.values.size(); ++k) {
            const double below = axis.height(sum);
            sum += bar.values[k];
            const double above = axis.height(sum);
            if (above > below)
                add("<rect x=\"{:.1f}\" y=\"{:.2f}\" width=\"{:.1f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                    center - width / 2, base - above, width, above - below, kColors.at(k));
        }
        if (bar.highest > bar.lowest)
            add("<line x1=\"{0:.1f}\" y1=\"{1:.2f}\" x2=\"{0:.1f}\" y2=\"{2:.2f}\" stroke=\"#222\"/>\n",
                center, base - axis.height(bar.lowest), base - axis.height(bar.highest));
        if (sum > 0)
            add("<text x=\"{:.1f}\" y=\"{:.2f}\" text-anchor=\"middle\" font-size=\"9\">{}</text>\n", center,
                base - std::max(axis.height(sum), axis.height(bar.highest)) - 4,
                format_value(chart_.unit, sum));
        if (!bar.note.empty())
            add("<text transform=\"translate({:.1f} {:g}) rotate(-90)\" font-size=\"11\" "
                "fill=\"#a00\">{}</text>\n",
                center + 4, base - 8, escape(bar.note));
        add("<text transform=\"translate({:.1f} {:g}) rotate(-35)\" text-anchor=\"end\" "
            "font-size=\"11\">{}</text>\n",
            center + 4, base + 14, escape(bar.label));
    }

    const Chart& chart_;
    std::string text_;
};

} // namespace

std::string format_value(Unit unit, double value) {
    const auto format = [](double number, const char* name) {
        return number >= 100 ? fmt::format("{:.0f} {}", number, name)
                             : fmt::format("{:.3g} {}", number, name);
    };
    if (value == 0) return "0";
    if (unit == Unit::milliseconds) {
        if (value >= 1000) return format(value / 1000, "s");
        return value >= 0.1 ? format(value, "ms") : format(value * 1000, "us");
    }
    for (const auto& [size, name] : {std::pair(1e12, "TB"), {1e9, "GB"}, {1e6, "MB"}, {1e3, "KB"}})
        if (value >= size) return format(value / size, name);
    return format(value, "B");
}

std::string make_bar_chart(const Chart& chart) { return ChartWriter(chart).write(); }

} // namespace relief::bench
