!> The physics of flash heating (Rice 2006; Noda, Dunham and Rice 2009) on plain numbers: friction
!> in steady sliding falls from that of rate-and-state friction to f_w where asperities melt, beyond
!> the slip rate v_w,
!>
!>     f_ss = f_w + (f_LV - f_w) G,   G = (1 + (v/v_w)^n)^(-1/n)
!>
!> Over the direct effect a, and as a change of ln(theta) in steady sliding; with bounds of both
!> between two slip rates (docs/theory.md, section 12). A core uses nothing but the kind of its
!> numbers, and other cores (src/CMakeLists.txt).
module friction_flash_heating_core
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_rate_state_core, only : asinh_exp, decayed_part, mean_decay, slope_asinh_exp
    implicit none
    private

    public :: bounds_between, heating, shift_slope, sliding_at, steady_bounds, steady_sliding

    real(wp), parameter :: least_ratio = 1.0e-100_wp   !! of f_ss/a, which ends there
    real(wp), parameter :: ln_2 = 0.693147180559945309417232121458176568_wp

    !> Constants of the law, as its formulas take them.
    type :: heating
        real(wp) :: ln_v0, ln_v_w
        real(wp) :: f0      !! f0/a
        real(wp) :: b       !! b/a, > 0
        real(wp) :: f_w     !! f_w/a
        real(wp) :: n       !! how sharply friction falls at v_w, >= 1
    end type heating

    !> Steady sliding at a slip rate.
    type :: steady_sliding
        real(wp) :: ln_v
        real(wp) :: low        !! f_LV/a
        real(wp) :: g, lost    !! G, and 1 - G without cancellation
        real(wp) :: h          !! -d(ln G)/d(ln v)
        real(wp) :: rise       !! ln sinh(f_ss/a) - ln sinh(f_LV/a)
        real(wp) :: ln_sinh    !! ln sinh(f_ss/a)
        real(wp) :: growth     !! d(ln sinh(f_ss/a))/d(ln v)
    end type steady_sliding

    !> Bounds between two slip rates.
    type :: steady_bounds
        real(wp) :: ln_low, ln_high           !! of ln(theta/d_c) in steady sliding
        real(wp) :: growth_low, growth_high   !! of d(ln sinh(f_ss/a))/d(ln v)
    end type steady_bounds

contains

    elemental function sliding_at(this, ln_v) result(steady)
        type(heating), intent(in) :: this
        real(wp), intent(in) :: ln_v
        type(steady_sliding) :: steady
        real(wp) :: beyond, u, x, l, y, part

        beyond = ln_v - this%ln_v0
        u = beyond - ln_2 + (this%f0 - this%b * beyond)
        x = this%n * (ln_v - this%ln_v_w)
        l = kept_share(x, this%n)
        steady%ln_v = ln_v
        steady%low = asinh_exp(u)
        steady%g = exp(-l)
        steady%lost = l * mean_decay(l, steady%g)
        steady%h = weak_part(x)
        y = steady_ratio(steady%low, this%f_w, steady%g, steady%lost)
        part = decayed_part(y, exp(-y))
        steady%growth = (2.0_wp - part) / part * steady_ratio_slope(steady%low, &
            slope_asinh_exp(u) * (1.0_wp - this%b), this%f_w, steady%g, steady%h)
        if (y <= least_ratio) steady%growth = 0.0_wp   ! at its end
        steady%ln_sinh = y + log(0.5_wp * part)
        steady%rise = steady%ln_sinh - u
    end function sliding_at

    !> How the shift of ln(theta) in steady sliding, rise/b, grows with ln(v).
    elemental function shift_slope(b, growth) result(slope)
        real(wp), intent(in) :: b        !! b/a, > 0
        real(wp), intent(in) :: growth   !! of ln sinh(f_ss/a)
        real(wp) :: slope

        slope = (growth - (1.0_wp - b)) / b
    end function shift_slope

    !> ln(1 + e^x)/n, so that G is e^- of it.
    elemental function kept_share(x, n) result(l)
        real(wp), intent(in) :: x   !! n ln(v/v_w)
        real(wp), intent(in) :: n   !! >= 1
        real(wp) :: l
        real(wp) :: t

        t = exp(-abs(x))
        l = (max(x, 0.0_wp) + 2.0_wp * atanh(t / (2.0_wp + t))) / n
    end function kept_share

    !> e^x/(1 + e^x) = -d(ln G)/d(ln v)
    elemental function weak_part(x) result(h)
        real(wp), intent(in) :: x   !! n ln(v/v_w)
        real(wp) :: h               !! 0 to 1
        real(wp) :: t

        t = exp(-abs(x))
        h = merge(1.0_wp, t, x > 0.0_wp) / (1.0_wp + t)
    end function weak_part

    !> f_ss/a
    elemental function steady_ratio(y, w, g, lost) result(ratio)
        real(wp), intent(in) :: y      !! f_LV/a, >= 0
        real(wp), intent(in) :: w      !! f_w/a, >= 0
        real(wp), intent(in) :: g      !! G
        real(wp), intent(in) :: lost   !! 1 - G
        real(wp) :: ratio

        ratio = max(w * lost + y * g, least_ratio)
    end function steady_ratio

    !> Its derivative by ln(v).
    elemental function steady_ratio_slope(y, y_slope, w, g, h) result(slope)
        real(wp), intent(in) :: y, w, g
        real(wp), intent(in) :: y_slope   !! of y by ln(v)
        real(wp), intent(in) :: h         !! see `weak_part`
        real(wp) :: slope

        slope = g * (y_slope + h * (w - y))
    end function steady_ratio_slope

    !> Bounds of the growth of ln sinh(f_ss/a) with ln(v), once by the factors of
    !>
    !>     growth = u' G C + coth(y) G h (w - y_LV),   C = tanh(y_LV)/tanh(y)
    !>
    !> at both ends, which is close where these are, and once for all rates up to the larger one;
    !> the closer of the two counts. From them bounds of ln(theta/d_c) in steady sliding, whose
    !> derivative is (growth - 1)/b.
    elemental function bounds_between(this, first, last) result(bounds)
        type(heating), intent(in) :: this
        type(steady_sliding), intent(in) :: first, last   !! at the smaller and the larger rate
        type(steady_bounds) :: bounds
        real(wp) :: near_low, near_high, low, high, from, to, width, gained, share
        real(wp) :: at_least, at_most

        call growth_between(this, first, last, near_low, near_high)
        call growth_below(this, first, last, low, high)
        bounds%growth_low = min(max(near_low, low), first%growth, last%growth)
        bounds%growth_high = max(min(near_high, high), first%growth, last%growth)
        from = first%rise / this%b - first%ln_v
        to = last%rise / this%b - last%ln_v
        low = (bounds%growth_low - 1.0_wp) / this%b
        high = (bounds%growth_high - 1.0_wp) / this%b
        ! Straight lines from both ends meet below and above.
        width = last%ln_v - first%ln_v
        gained = to - from
        share = max(high - low, tiny(width))
        at_least = from + low * max(0.0_wp, min((high * width - gained) / share, width))
        at_most = from + high * max(0.0_wp, min((gained - low * width) / share, width))
        bounds%ln_low = max(min(at_least, from, to), min(to, -last%ln_v))
        bounds%ln_high = max(at_most, from, to)
    end function bounds_between

    elemental subroutine growth_between(this, first, last, least, most)
        type(heating), intent(in) :: this
        type(steady_sliding), intent(in) :: first, last
        real(wp), intent(out) :: least, most
        real(wp) :: low, high, y_low, y_high, part, coth_low, coth_high, pull, share_low, share_high

        low = min(first%low, last%low)
        high = max(first%low, last%low)
        ! it is bilinear: its extremes are at the corners
        y_low = min(steady_ratio(low, this%f_w, first%g, first%lost), steady_ratio(low, this%f_w, &
            last%g, last%lost))
        y_high = max(steady_ratio(high, this%f_w, first%g, first%lost), steady_ratio(high, &
            this%f_w, last%g, last%lost))
        part = decayed_part(y_low, exp(-y_low))
        coth_low = (2.0_wp - part) / part   ! of the lower y: the larger one
        part = decayed_part(y_high, exp(-y_high))
        coth_high = (2.0_wp - part) / part
        share_low = tanh(low) * coth_high * last%g
        share_high = min(tanh(high) * coth_low * first%g, 1.0_wp)
        least = (1.0_wp - this%b) * merge(share_low, share_high, this%b <= 1.0_wp)
        most = (1.0_wp - this%b) * merge(share_high, share_low, this%b <= 1.0_wp)
        pull = this%f_w - high
        least = least + pull * merge(coth_high * (last%g * first%h), coth_low * (first%g &
            * last%h), pull > 0.0_wp)
        pull = this%f_w - low
        most = most + pull * merge(coth_low * (first%g * last%h), coth_high * (last%g &
            * first%h), pull > 0.0_wp)
        if (y_high <= least_ratio) then   ! it is at its end, and the growth none
            least = 0.0_wp
            most = 0.0_wp
        end if
    end subroutine growth_between

    !> G C is between 0 and 1, and coth(y) below 1 + 1/y. At e^-d times v_w, or times the larger
    !> rate if that is less, y_LV is at most (b - 1) d more than there, and h, but for a factor of
    !> two, e^(-n d) of that there: d e^(-n d) is below 1/(e n).
    elemental subroutine growth_below(this, first, last, least, most)
        type(heating), intent(in) :: this
        type(steady_sliding), intent(in) :: first, last
        real(wp), intent(out) :: least, most
        real(wp) :: beyond, heated, highest

        beyond = min(this%ln_v_w, last%ln_v) - this%ln_v0
        heated = min(1.0_wp, 2.0_wp * last%h)
        highest = max(asinh_exp(beyond - ln_2 + (this%f0 - this%b * beyond)), last%low) - this%f_w
        highest = max(0.0_wp, highest) + max(0.0_wp, this%b - 1.0_wp) * exp(-1.0_wp) / this%n
        least = min(1.0_wp - this%b, 0.0_wp) - heated * (highest + 1.0_wp)
        most = max(1.0_wp - this%b, 0.0_wp) + this%f_w * heated + this%n
    end subroutine growth_below

end module friction_flash_heating_core
