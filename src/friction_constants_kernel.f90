!> The constants of a block of contact points that have their own, checked and put in columns, in
!> vector lanes. Compiled once for each vector instruction set, as `friction_batch_kernel` is.
module friction_constants_kernel
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t
    use friction_lane_block, only : c_cap, c_mu_0, c_own, c_squeeze, constants_source, lanes, &
        n_constants, no_cap
    implicit none
    private

    public :: copy_constants

    integer, parameter :: wp = c_double

    !> Constants that are not zero are of ordinary size, or lanes do not take them.
    real(wp), parameter :: least = 1.0e-20_wp, most = 1.0e20_wp

contains

    !> The constants of points 1 to `count`, and of lanes without a point those of the source. A
    !> point that is left has those of the source, too; the routine for one point then judges it.
    pure subroutine copy_constants(source, stride, count, props, constants, left) &
        bind(C, name='stickslip_constants_kernel')
        type(constants_source), intent(in) :: source
        integer(c_int64_t), value, intent(in) :: stride   !! distance of constants, `count` or more
        integer(c_int), value, intent(in) :: count        !! points, `lanes` at most
        real(wp), intent(in) :: props(stride, *)
        real(wp), intent(out) :: constants(lanes, n_constants)
        integer(c_int), intent(out) :: left(lanes)        !! 1 for a point that is left, else 0
        integer(c_int64_t) :: wrong(lanes), any_wrong
        real(wp) :: chosen(lanes)
        integer :: used, i, k

        used = c_own + source%n_own - 1
        wrong = 0
        do k = 1, source%n_choices
            call copy_column(count, props(:count, source%choice(k)), source%chosen(k), chosen)
            call judge(chosen, bits(source%chosen(k)), bits(source%chosen(k)), .false., wrong)
        end do
        do k = 1, used
            if (source%place(k) > 0) then
                call copy_column(count, props(:count, source%place(k)), source%value(k), &
                    constants(:, k))
                call judge(constants(:, k), bits(max(least, source%lower(k))), &
                    bits(min(most, source%upper(k))), source%lower(k) <= 0.0_wp, wrong)
            else
                constants(:, k) = source%value(k)
            end if
        end do
        do k = c_own, used
            if (source%not_below(k) > 0) call compare(constants(:, source%not_below(k)), &
                constants(:, k), wrong)
            if (source%not_above(k) > 0) call compare(constants(:, k), &
                constants(:, source%not_above(k)), wrong)
        end do
        left = 0
        any_wrong = 0
        do i = 1, lanes
            any_wrong = ior(any_wrong, wrong(i))
        end do
        if (any_wrong < 0) then
            left = merge(1_c_int, 0_c_int, wrong < 0)
            do k = 1, used
                where (left > 0) constants(:, k) = source%value(k)
            end do
        end if
        constants(:, c_mu_0) = -1.0_wp   ! no law admits it: virgin points go one by one
        if (source%place(c_cap) > 0) then
            do i = 1, lanes
                if (constants(i, c_cap) <= 0.0_wp) constants(i, c_cap) = no_cap
            end do
        end if
        if (source%place(c_squeeze) > 0) call invert(constants(:, c_squeeze))
    end subroutine copy_constants

    !> A number of all points, and `value` for lanes without one.
    pure subroutine copy_column(count, from, value, to)
        integer, intent(in) :: count
        real(wp), intent(in) :: from(count), value
        real(wp), intent(out) :: to(lanes)

        if (count == lanes) then
            to = from(:lanes)   ! a length that the compiler knows
        else
            to(:count) = from
            to(count + 1:) = value
        end if
    end subroutine copy_column

    !> Numbers between two others, as integers; or zeros, where these are admitted.
    pure subroutine judge(values, low, high, zero_too, wrong)
        real(wp), intent(in) :: values(lanes)
        integer(c_int64_t), intent(in) :: low, high       !! of numbers >= 0
        logical, intent(in) :: zero_too
        integer(c_int64_t), intent(inout) :: wrong(lanes)   !! below 0 for what cannot be taken
        integer(c_int64_t) :: number, refused
        integer :: i

        refused = merge(0_c_int64_t, -1_c_int64_t, zero_too)
        do i = 1, lanes
            number = bits(values(i))   ! signs tell, also of differences that overflow below 0
            wrong(i) = ior(ior(wrong(i), number), ior(high - number, &
                iand(number - low, ior(-number, refused))))
        end do
    end subroutine judge

    !> A constant that must not be above another one.
    pure subroutine compare(lower, upper, wrong)
        real(wp), intent(in) :: lower(lanes), upper(lanes)
        integer(c_int64_t), intent(inout) :: wrong(lanes)   !! below 0 for what cannot be taken
        integer :: i

        do i = 1, lanes
            wrong(i) = ior(wrong(i), bits(upper(i)) - bits(lower(i)))
        end do
    end subroutine compare

    !> mu_1/mu_2 from mu_2/mu_1, where 0 stands for 1.
    pure subroutine invert(ratio)
        real(wp), intent(inout) :: ratio(lanes)
        integer :: i

        do i = 1, lanes
            ratio(i) = 1.0_wp / merge(ratio(i), 1.0_wp, ratio(i) > 0.0_wp)
        end do
    end subroutine invert

    !> A number as an integer, which orders those above zero as they are: silent where a comparison
    !> with NaN raises an exception.
    elemental function bits(x)
        real(wp), intent(in) :: x
        integer(c_int64_t) :: bits

        bits = transfer(x, bits)
    end function bits

end module friction_constants_kernel
