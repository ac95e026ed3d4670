!> The constants of a block of contact points that have their own, checked and put in columns, in
!> vector lanes. Compiled once for each vector instruction set, as `friction_batch_kernel` is.
module friction_constants_kernel
    use, intrinsic :: iso_c_binding, only : c_double, c_int, c_int64_t
    use friction_lane_block, only : c_cap, c_mu_0, c_own, c_squeeze, constants_source, lanes, &
        n_constants, no_cap, with_cap, with_two_coefficients
    implicit none
    private

    public :: copy_constants

    integer, parameter :: wp = c_double

    !> Constants that are not zero are of ordinary size, or lanes do not take them.
    real(wp), parameter :: least = 1.0e-20_wp, most = 1.0e20_wp

contains

    !> The constants of points 1 to `count`, and of lanes without a point those of the source. A
    !> point that is left has those of the source, too; the routine for one point then judges it.
    pure subroutine copy_constants(source, stride, count, props, constants, options, left) &
        bind(C, name='stickslip_constants_kernel')
        type(constants_source), intent(in) :: source
        integer(c_int64_t), value, intent(in) :: stride   !! distance of constants, `count` or more
        integer(c_int), value, intent(in) :: count        !! points, `lanes` at most
        real(wp), intent(in) :: props(stride, *)
        real(wp), intent(out) :: constants(lanes, n_constants)
        integer(c_int), intent(out) :: options            !! sum of those that a point has
        integer(c_int), intent(out) :: left(lanes)        !! 1 for a point that is left, else 0
        integer(c_int64_t) :: wrong(lanes), any_wrong
        integer :: i, k

        call compare(source, stride, count, props, wrong)
        do k = 1, c_own + source%n_own - 1
            if (source%place(k) == 0 .or. count < lanes) constants(:, k) = source%value(k)
            if (source%place(k) > 0) call copy_column(count, props(:count, source%place(k)), &
                source%lower(k) > 0.0_wp, source%value(k), constants(:, k), wrong)
        end do
        do k = c_squeeze, c_own + source%n_own - 1
            call follow_rules(source, k, constants, wrong)
        end do
        constants(:, c_mu_0) = -1.0_wp   ! no law admits it: virgin points go one by one
        options = 0
        if (source%place(c_cap) > 0) call find_option(constants(:, c_cap), no_cap, with_cap, &
            options)
        if (source%place(c_squeeze) > 0) then
            call find_option(constants(:, c_squeeze), 1.0_wp, with_two_coefficients, options)
            if (iand(options, with_two_coefficients) > 0) then   ! mu_1/mu_2 from mu_2/mu_1
                do i = 1, lanes
                    constants(i, c_squeeze) = 1.0_wp / constants(i, c_squeeze)
                end do
            end if
        end if
        left = 0
        any_wrong = 0
        do i = 1, lanes
            any_wrong = ior(any_wrong, wrong(i))
        end do
        if (any_wrong == 0) return
        left = merge(1_c_int, 0_c_int, wrong /= 0)
        do k = 1, c_own + source%n_own - 1
            where (left > 0) constants(:, k) = source%value(k)
        end do
    end subroutine copy_constants

    !> One constant of all points; one that is not of ordinary size is replaced.
    pure subroutine copy_column(count, from, not_zero, value, to, wrong)
        integer, intent(in) :: count
        real(wp), intent(in) :: from(count)
        logical, intent(in) :: not_zero
        real(wp), intent(in) :: value   !! that replaces it
        real(wp), intent(inout) :: to(lanes)
        integer(c_int64_t), intent(inout) :: wrong(lanes)   !! not 0 for what cannot be taken
        integer(c_int64_t) :: number, zero, ordinary, low, high, other
        integer :: i

        zero = merge(bits(most), 0_c_int64_t, not_zero)   ! that is refused, too
        low = bits(least)
        high = bits(most)
        other = bits(value)
        do i = 1, count
            number = bits(from(i))
            ! all bits or none
            ordinary = iand(shifta(low - number, 63), shifta(number - high, 63))
            if (number == zero) ordinary = -1
            to(i) = transfer(ior(iand(number, ordinary), iand(other, not(ordinary))), value)
            wrong(i) = ior(wrong(i), not(ordinary))
        end do
    end subroutine copy_column

    !> Constants that have to be the same at all points, in one pass. Compares bits: silent where a
    !> comparison with NaN raises an exception.
    pure subroutine compare(source, stride, count, props, wrong)
        type(constants_source), intent(in) :: source
        integer(c_int64_t), intent(in) :: stride
        integer, intent(in) :: count
        real(wp), intent(in) :: props(stride, *)
        integer(c_int64_t), intent(out) :: wrong(lanes)
        integer :: i

        wrong = 0
        associate (at => source%choice, value => source%chosen)
            do i = 1, count
                wrong(i) = ior(ior(ior(differ(props(i, at(1)), value(1)), &
                    differ(props(i, at(2)), value(2))), &
                    ior(differ(props(i, at(3)), value(3)), differ(props(i, at(4)), value(4)))), &
                    ior(differ(props(i, at(5)), value(5)), differ(props(i, at(6)), value(6))))
            end do
        end associate
    end subroutine compare

    !> 0 for the same number.
    elemental function differ(x, y)
        real(wp), intent(in) :: x, y
        integer(c_int64_t) :: differ

        differ = ieor(bits(x), bits(y))
    end function differ

    !> Rules of module friction_law_constants that lanes can break although their constants are of
    !> ordinary size.
    pure subroutine follow_rules(source, k, constants, wrong)
        type(constants_source), intent(in) :: source
        integer, intent(in) :: k   !! column
        real(wp), intent(in) :: constants(lanes, n_constants)
        integer(c_int64_t), intent(inout) :: wrong(lanes)

        if (source%lower(k) > least) where (constants(:, k) < source%lower(k)) wrong = 1
        if (source%upper(k) < most) where (constants(:, k) > source%upper(k)) wrong = 1
        if (source%not_below(k) > 0) where (constants(:, k) < constants(:, source%not_below(k))) &
            wrong = 1
        if (source%not_above(k) > 0) where (constants(:, k) > constants(:, source%not_above(k))) &
            wrong = 1
    end subroutine follow_rules

    !> A number that stands for no option where a point says 0; and whether a point has the option.
    pure subroutine find_option(values, none, option, options)
        real(wp), intent(inout) :: values(lanes)
        real(wp), intent(in) :: none
        integer(c_int), intent(in) :: option
        integer(c_int), intent(inout) :: options   !! sum of those that a point has
        integer(c_int64_t) :: others
        integer :: i

        others = 0
        do i = 1, lanes
            values(i) = merge(values(i), none, values(i) > 0.0_wp)
            others = ior(others, differ(values(i), none))
        end do
        if (others /= 0) options = options + option
    end subroutine find_option

    !> A number as an integer, which orders those above zero as they are: silent where a comparison
    !> with NaN raises an exception.
    elemental function bits(x)
        real(wp), intent(in) :: x
        integer(c_int64_t) :: bits

        bits = transfer(x, bits)
    end function bits

end module friction_constants_kernel
