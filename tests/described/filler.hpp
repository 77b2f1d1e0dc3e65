// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <string_view>

#include "base/field_forms.hpp"
#include "haptic_bridge/link/message_forms.hpp"

namespace described {

/// Visits the fields of a value and fills them with random values that their forms allow. Leaves a member with an
/// unknown form as it is.
class Filler {
public:
    explicit Filler(std::mt19937& random) : random_(random) {}

    template <class Member>
    void operator()(std::string_view /*name*/, Member&& member) {
        fill(member);
    }
    [[nodiscard]] static bool knows(bool known) { return known; }

private:
    std::size_t below(std::size_t end) { return random_() % end; }

    template <class Number>
    Number numberBetween(Number least, Number most) {
        if constexpr (std::is_floating_point_v<Number>) {
            const double share = static_cast<double>(random_()) / std::mt19937::max();
            return static_cast<Number>(least * (1 - share) + most * share);
        } else {
            return static_cast<Number>(std::uniform_int_distribution<std::int64_t>(
                static_cast<std::int64_t>(least), static_cast<std::int64_t>(most))(random_));
        }
    }

    template <class Member>
    void fill(Member& member) {
        using T = std::remove_cvref_t<Member>;
        if constexpr (requires { form(member); }) {
            form(member);
        } else if constexpr (std::same_as<T, bool>) {
            member = below(2) == 1;
        } else if constexpr (base::NamedEnum<T>) {
            member = valuesOf(T{})[below(valuesOf(T{}).size())].value;
        } else if constexpr (std::is_floating_point_v<T>) {
            member = numberBetween<T>(-2, 2);
        } else if constexpr (std::is_arithmetic_v<T>) {
            member = static_cast<T>(random_() >> below(32));
        } else if constexpr (base::detail::Array<T>) {
            for (auto& element : member) {
                fill(element);
            }
        } else if constexpr (base::detail::Vector<T>) {
            for (int i = 0; i < T::length(); ++i) {
                fill(member[i]);
            }
        } else if constexpr (base::detail::kIsPair<T>) {
            fill(member.first);
            fill(member.second);
        } else if constexpr (base::detail::kIsOptional<T>) {
            fillOptional(member);
        } else if constexpr (std::same_as<T, sand::Heading>) {
            member = *sand::headingOf(numberBetween(-180.0, 180.0), below(2) == 1);
        } else if constexpr (std::same_as<T, sand::Tool>) {
            T::fields(member, *this);
            member.halfWidth = sand::isRound(member.kind) ? 0 : member.halfWidth;
        } else if constexpr (base::Described<T>) {
            T::fields(member, *this);
        }
    }

    template <class Optional>
    void fillOptional(Optional& value) {
        value.reset();
        if (below(2) == 1) {
            fill(value.emplace());
        }
    }
    template <class List>
    void fillList(List& list, std::size_t most) {
        list.clear();
        for (std::size_t count = below(std::min<std::size_t>(most, 4) + 1); count > 0; --count) {
            fill(list.emplace_back());
        }
    }
    std::string word(std::size_t most) {
        std::string word(below(std::min<std::size_t>(most, 8) + 1), 'a');
        for (char& letter : word) {
            letter = static_cast<char>('a' + below(26));
        }
        return word;
    }

    template <class Number>
    void form(base::Varint<Number> it) {
        fill(it.value);
        if constexpr (std::is_signed_v<Number>) {
            it.value = it.value < 0 ? static_cast<Number>(-(it.value + 1)) : it.value;
        }
    }
    template <class Number>
    void form(base::Limited<Number> it) {
        it.value = numberBetween(it.least, it.most);
    }
    template <class Float>
    void form(base::AnyFloat<Float> it) {
        fill(it.value);
        it.value = below(4) == 0 ? std::numeric_limits<Float>::infinity() : it.value;
    }
    template <class Number>
    void form(base::Constant<Number> /*it*/) {}
    template <class Number, class Bool, std::size_t kCount>
    void form(base::Flags<Number, Bool, kCount> it) {
        for (Bool* value : it.values) {
            *value = below(2) == 1;
        }
    }
    template <class Enum, class Elements>
    void form(base::ByName<Enum, Elements> it) {
        fill(it.value);
    }
    template <class List, class Count>
    void form(base::UpTo<List, Count> it) {
        fillList(it.value, it.most);
    }
    template <class List>
    void form(base::ToEnd<List> it) {
        fillList(it.value, 4);
    }
    template <class List>
    void form(base::Exactly<List> it) {
        it.value.resize(it.count);
        for (auto& element : it.value) {
            fill(element);
        }
    }
    template <class Text>
    void form(base::TextUpTo<Text> it) {
        it.value = word(it.most);
    }
    template <class Optional>
    void form(base::SpacedOptional<Optional> it) {
        fillOptional(it.value);
    }
    template <class Optional>
    void form(base::OptionalBlock<Optional> it) {
        fillOptional(it.value);
    }
    template <class Optional>
    void form(base::OptionalText<Optional> it) {
        it.value.reset();
        if (below(2) == 1) {
            it.value = word(it.most);
        }
    }
    template <class Texts>
    void form(base::TextsUpTo<Texts> it) {
        it.value.assign(below(4), word(it.most));
    }
    template <class AnyBytes>
    void form(base::Block<AnyBytes> it) {
        fillList(it.value, 4);
    }
    template <class AnyBytes>
    void form(base::Rest<AnyBytes> it) {
        fillList(it.value, 4);
    }
    template <class Number>
    void form(base::Padding<Number> it) {
        it.count = static_cast<Number>(below(20));
    }
    template <class Text>
    void form(haptic_bridge::PrintedText<Text> it) {
        it.value = word(it.most);
    }
    template <class Text>
    void form(haptic_bridge::Reason<Text> it) {
        it.value = word(8);
    }
    template <class Edit>
    void form(haptic_bridge::WholeEdit<Edit> it) {
        it.value = below(2) == 1 ? Edit(Edit::Kind::settle) : Edit::loaded({1, 2, 3});
        it.value.number = 1 + below(1000);
    }
    void form(sand::Owed& owed) {
        owed.whole = below(2) == 0 ? sand::Owed::kUntilRest : static_cast<std::int32_t>(below(sand::kMostSweeps));
        owed.done = owed.whole == 0 ? 0 : static_cast<std::int32_t>(below(static_cast<std::size_t>(owed.whole)));
    }
    void form(sand::Step& step) {
        step = {
            .epoch = 1, .number = below(1000), .engaged = below(2) == 1, .path = {{600, 700, 100}, {-9, 0, 1 << 20}}};
        step.path.resize(below(3));
        step.sweeps = static_cast<std::int32_t>(below(sand::kMostSweeps + 1));
    }

    std::mt19937& random_;
};

}  // namespace described
