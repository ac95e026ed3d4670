!> When a spring and a surface of rate-and-state friction balance once: docs/theory.md, section 12.
!>
!> With x = slip/d_c and X of the law, the spring asks for ln sinh(t - k x) where the law has X(x);
!> t = trial/(a p), k = stiffness d_c/(a p). The misfit X - ln sinh(t - k x) comes from below zero
!> and ends above. Where it rises along every range of x in which it may be zero, that happens once.
!>
!> Bounds of X and of its slope over fixed ranges of x, whose exponentials the compiler knows. On
!> plain numbers, as a core, for law and lanes alike (src/CMakeLists.txt).
module friction_rate_state_bounds
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_rate_state_core, only : mean_growth
    implicit none
    private

    public :: aged_bounds, aged_fall, joined, may_turn, may_turn_far, may_vanish, pressed_range, &
        ranges, slip_range, slipped_bounds, slipped_fall

    !> From one x to another.
    type :: slip_range
        real(wp) :: from, to             !! x
        real(wp) :: ln_from, ln_to
        real(wp) :: left_from, left_to   !! e^-x
        real(wp) :: mean_from, mean_to   !! (1 - e^-x)/x
        real(wp) :: fall_from, fall_to   !! minus the derivative of that
    end type slip_range

    integer, parameter :: n_ranges = 39
    integer :: k
    real(wp), parameter :: ln_2 = log(2.0_wp)
    real(wp), parameter :: far = 512.0_wp      !! where the ranges end: nothing is left of e^-x
    real(wp), parameter :: ln_least = -231.0_wp   !! below ln of the least slip over d_c
    real(wp), parameter :: more = 1.0e-8_wp    !! than the round-off of what stands here
    real(wp), parameter :: ends(n_ranges) = [(far * 2.0_wp**(0.5_wp * (k - n_ranges)), &
        k = 1, n_ranges)]
    real(wp), parameter :: means(n_ranges) = (1.0_wp - exp(-ends)) / ends
    real(wp), parameter :: falls(n_ranges) = (means - exp(-ends)) / ends

    type(slip_range), parameter :: ranges(n_ranges) = [ &
        slip_range(0.0_wp, ends(1), ln_least, log(ends(1)), 1.0_wp, exp(-ends(1)), 1.0_wp, &
        means(1), 0.5_wp, falls(1)), &
        (slip_range(ends(k), ends(k + 1), log(ends(k)), log(ends(k + 1)), exp(-ends(k)), &
        exp(-ends(k + 1)), means(k), means(k + 1), falls(k), falls(k + 1)), k = 1, n_ranges - 1)]

contains

    !> From the start of one range to the end of another.
    elemental function joined(first, last) result(range)
        type(slip_range), intent(in) :: first, last
        type(slip_range) :: range

        range = slip_range(first%from, last%to, first%ln_from, last%ln_to, first%left_from, &
            last%left_to, first%mean_from, last%mean_to, first%fall_from, last%fall_to)
    end function joined

    !> For the ageing law where the pressure takes `pressed` from ln(theta) in the increment (Linker
    !> and Dieterich): as a slip does, but the spring stays where it is.
    elemental function pressed_range(range, pressed) result(moved)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: pressed   !! within 200 of zero
        type(slip_range) :: moved

        moved = range
        moved%left_from = range%left_from * exp(-pressed)
        moved%left_to = range%left_to * exp(-pressed)
        call mean_growth(range%from + pressed, moved%left_from, moved%mean_from, moved%fall_from)
        call mean_growth(range%to + pressed, moved%left_to, moved%mean_to, moved%fall_to)
    end function pressed_range

    !> How fast ln(theta) falls with x by the ageing law, at most.
    elemental function aged_fall(range, ratio) result(fall)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: ratio   !! theta at the start over dt, > 0
        real(wp) :: fall

        fall = min((ratio * range%left_from + range%fall_from) / (ratio * range%left_to &
            + range%mean_to), 1.0_wp)
    end function aged_fall

    !> ln(theta/dt) in a range.
    elemental subroutine aged_bounds(range, ratio, low, high)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: ratio   !! as above
        real(wp), intent(out) :: low, high

        low = log(ratio * range%left_to + range%mean_to)
        high = log(ratio * range%left_from + range%mean_from)
    end subroutine aged_bounds

    !> How fast ln(theta) falls with x by the slip law, at most. The pressure takes `pressed` from
    !> it in the increment (Linker and Dieterich).
    elemental function slipped_fall(range, pull, growth, pressed) result(fall)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: pull      !! ln(theta) of steady sliding less that at the start, at
                                          !! least
        real(wp), intent(in) :: growth    !! of ln(theta) of steady sliding with ln(slip rate), at
                                          !! least; -1 but for extensions
        real(wp), intent(in) :: pressed
        real(wp) :: fall

        fall = -pull * merge(range%left_to, range%left_from, pull > 0.0_wp) &
            - growth * merge(range%mean_to, range%mean_from, growth > 0.0_wp) &
            - pressed * merge(range%fall_to, range%fall_from, pressed > 0.0_wp)
    end function slipped_fall

    !> ln(theta) in a range, less that at the start.
    elemental subroutine slipped_bounds(range, least, most, pressed, low, high)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: least, most   !! pulls, see above
        real(wp), intent(in) :: pressed
        real(wp), intent(out) :: low, high
        real(wp) :: from, to

        from = range%from * range%mean_from
        to = range%to * range%mean_to
        low = least * merge(from, to, least > 0.0_wp) &
            - pressed * merge(range%mean_from, range%mean_to, pressed > 0.0_wp)
        high = most * merge(to, from, most > 0.0_wp) &
            - pressed * merge(range%mean_to, range%mean_from, pressed > 0.0_wp)
    end subroutine slipped_bounds

    !> May the misfit stop rising in a range?
    elemental function may_turn(range, k, fall) result(may)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: k      !! see above, > 0
        real(wp), intent(in) :: fall   !! of X - ln(x) with x, at most
        real(wp) :: may                !! above 0 if it may

        ! coth of what the spring asks for is above 1, and 1/x in the range above 1/to
        may = range%to * (fall + more * abs(fall) - k) - 1.0_wp
    end function may_turn

    !> May it be zero there?
    elemental function may_vanish(range, t, k, low, high) result(may)
        type(slip_range), intent(in) :: range
        real(wp), intent(in) :: t, k        !! see above, > 0
        real(wp), intent(in) :: low, high   !! bounds of X - ln(x)
        real(wp) :: may                     !! above 0 if it may
        real(wp), parameter :: least = 1.0_wp, ln_part = log(1.0_wp - exp(-2.0_wp * least))
        real(wp) :: from, to, margin

        from = t - k * range%from
        to = t - k * range%to
        margin = more * (1.0_wp + t + abs(low) + abs(high))
        may = from - ln_2 - (range%ln_from + low) + margin   ! ln sinh(y) < y - ln 2
        if (to > least) may = min(may, range%ln_to + high - (to - ln_2 + ln_part) + margin)
        if (from < 0.0_wp) may = -1.0_wp   ! the spring has nothing left
    end function may_vanish

    !> `may_turn` beyond all ranges, where theta is nearly that of steady sliding.
    elemental function may_turn_far(k, b_over_a, ratio, pressed) result(may)
        real(wp), intent(in) :: k, b_over_a
        real(wp), intent(in) :: ratio     !! theta at the start over dt, > 0
        real(wp), intent(in) :: pressed   !! of ln(theta), within 200 of zero
        real(wp) :: may                   !! above 0 if it may

        may = b_over_a * (1.0_wp + more + max(0.0_wp, -pressed) / (far - max(0.0_wp, -pressed))) &
            - 1.0_wp - k * far
        if (ratio > 1.0e100_wp) may = 1.0_wp
    end function may_turn_far

end module friction_rate_state_bounds
