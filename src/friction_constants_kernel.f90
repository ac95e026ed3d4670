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

    !> The constants of points 1 to `count`. Lanes without a point, and with one that is left, get
    !> such as harm nobody; the routine for one point then judges that.
    pure subroutine copy_constants(source, stride, count, props, constants, options, left) &
        bind(C, name='stickslip_constants_kernel')
        type(constants_source), intent(in) :: source
        integer(c_int64_t), value, intent(in) :: stride   !! distance of constants, `count` or more
        integer(c_int), value, intent(in) :: count        !! points, `lanes` at most
        real(wp), intent(in) :: props(stride, *)
        real(wp), intent(out) :: constants(lanes, n_constants)
        integer(c_int), intent(out) :: options            !! sum of those that a point has
        integer(c_int), intent(out) :: left(lanes)        !! 1 for a point that is left, else 0
        logical :: fine
        integer :: used, i, k

        used = c_own + source%n_own - 1
        left = 0
        call copy_points(source, stride, count, props, constants, fine)
        if (.not. fine) then   ! which of them?
            do i = 1, count
                call copy_points(source, stride, 1, props(i, 1), constants(i, 1), fine)
                if (fine) cycle
                left(i) = 1
                constants(i, :used) = source%value(:used)
            end do
        end if
        do k = 1, used
            constants(count + 1:, k) = source%value(k)
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
    end subroutine copy_constants

    !> Those of `n` points, and whether lanes can take all of them.
    pure subroutine copy_points(source, stride, n, props, constants, fine)
        type(constants_source), intent(in) :: source
        integer(c_int64_t), intent(in) :: stride
        integer, intent(in) :: n
        real(wp), intent(in) :: props(stride, *)
        real(wp), intent(inout) :: constants(lanes, *)
        logical, intent(out) :: fine
        integer(c_int64_t) :: wrong, beyond   !! not 0, below 0 for what cannot be taken
        integer :: k, i

        wrong = 0
        beyond = 0
        do k = 1, source%n_choices
            call compare(n, props(:n, source%choice(k)), source%chosen(k), wrong)
        end do
        do k = 1, c_own + source%n_own - 1
            if (source%place(k) > 0) then
                call copy_column(n, props(:n, source%place(k)), source%lower(k), source%upper(k), &
                    constants(:n, k), beyond)
            else
                do i = 1, n
                    constants(i, k) = source%value(k)
                end do
            end if
        end do
        do k = c_own, c_own + source%n_own - 1
            if (source%not_below(k) > 0) call order(n, constants(:n, source%not_below(k)), &
                constants(:n, k), beyond)
            if (source%not_above(k) > 0) call order(n, constants(:n, k), &
                constants(:n, source%not_above(k)), beyond)
        end do
        fine = wrong == 0 .and. beyond >= 0
    end subroutine copy_points

    !> Constants that have to be the same at all points. Compares bits: silent where a comparison
    !> with NaN raises an exception.
    pure subroutine compare(n, values, chosen, wrong)
        integer, intent(in) :: n
        real(wp), intent(in) :: values(n), chosen
        integer(c_int64_t), intent(inout) :: wrong
        integer :: i

        do i = 1, n
            wrong = ior(wrong, ieor(bits(values(i)), bits(chosen)))
        end do
    end subroutine compare

    !> One constant: of ordinary size and within its bounds, or zero, where that is one.
    pure subroutine copy_column(n, from, lower, upper, to, beyond)
        integer, intent(in) :: n
        real(wp), intent(in) :: from(n), lower, upper
        real(wp), intent(inout) :: to(n)
        integer(c_int64_t), intent(inout) :: beyond
        integer(c_int64_t) :: low, high, number, out_of_bounds
        integer :: i

        high = min(bits(upper), bits(most))
        low = min(max(bits(lower), bits(least)), high)   ! above it, differences may overflow
        if (lower > 0.0_wp) then
            do i = 1, n
                number = bits(from(i))
                beyond = ior(beyond, ior(number - low, high - number))
                to(i) = from(i)
            end do
        else
            do i = 1, n
                number = bits(from(i))
                out_of_bounds = ior(number - low, high - number)
                if (number == 0) out_of_bounds = 0
                beyond = ior(beyond, out_of_bounds)
                to(i) = from(i)
            end do
        end if
    end subroutine copy_column

    !> Rules of module friction_law_constants: that one constant is not above another.
    pure subroutine order(n, lesser, greater, beyond)
        integer, intent(in) :: n
        real(wp), intent(in) :: lesser(n), greater(n)
        integer(c_int64_t), intent(inout) :: beyond
        integer :: i

        do i = 1, n
            beyond = ior(beyond, bits(greater(i)) - bits(lesser(i)))
        end do
    end subroutine order

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
            others = ior(others, bits(values(i)))
        end do
        if (others == 0) then
            values = none
            return
        end if
        others = 0
        do i = 1, lanes
            values(i) = merge(values(i), none, values(i) > 0.0_wp)
            others = ior(others, ieor(bits(values(i)), bits(none)))
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
