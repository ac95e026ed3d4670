!> Derivatives and roots of functions of one variable. A function is a type, so that it can carry
!> what it depends on.
module smooth_function
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: derivative, find_root, function_of_one

    integer, parameter, public :: values = 3   !! that a function has at a place

    type, abstract :: function_of_one
    contains
        procedure(value_interface), deferred :: at
    end type function_of_one

    abstract interface
        function value_interface(self, x) result(y)
            import :: dp, function_of_one, values
            implicit none
            class(function_of_one), intent(in) :: self
            real(dp), intent(in) :: x
            real(dp) :: y(values)   !! those that are not needed are 0
        end function value_interface
    end interface

contains

    !> Derivatives of smooth functions by differences over ever shorter steps, extrapolated to none
    !> (C. J. F. Ridders, Advances in Engineering Software 4, 1982): of each value the entry of the
    !> table that agrees best with its neighbours. Long steps keep round-off small, extrapolation
    !> removes what they leave out: the error is some units of round-off of the values.
    function derivative(f, x, step, one_sided) result(slope)
        class(function_of_one), intent(in) :: f
        real(dp), intent(in) :: x
        real(dp), intent(in) :: step          !! first to try; its sign tells the side
        logical, intent(in) :: one_sided      !! else to both sides
        real(dp) :: slope(values)
        integer, parameter :: rows = 12
        real(dp) :: table(values, rows, rows), error(values), now(values), h, factor
        integer :: i, j

        h = step
        error = huge(error)
        slope = 0.0_dp
        do i = 1, rows
            if (.not. abs((x + h) - x) > 0.0_dp) return   ! no shorter step changes x
            if (one_sided) then
                table(:, 1, i) = (f%at(x + h) - f%at(x)) / ((x + h) - x)
            else
                table(:, 1, i) = (f%at(x + h) - f%at(x - h)) / ((x + h) - (x - h))
            end if
            factor = 1.0_dp
            do j = 2, i
                factor = factor * merge(2.0_dp, 4.0_dp, one_sided)
                table(:, j, i) = (factor * table(:, j - 1, i) - table(:, j - 1, i - 1)) &
                    / (factor - 1.0_dp)
                now = max(abs(table(:, j, i) - table(:, j - 1, i)), &
                    abs(table(:, j, i) - table(:, j - 1, i - 1)))
                where (now < error)
                    error = now
                    slope = table(:, j, i)
                end where
            end do
            if (all(error <= epsilon(error) * abs(slope))) return
            h = 0.5_dp * h
        end do
    end function derivative

    !> Where the first value of a function changes its sign, to round-off: T. R. Chandrupatla's
    !> method (Advances in Engineering Software 28, 1997), inverse quadratic interpolation where
    !> that can be trusted, halving where not. A pole that changes the sign counts.
    real(dp) function find_root(f, from, to) result(x)
        class(function_of_one), intent(in) :: f
        real(dp), intent(in) :: from, to   !! the signs there differ
        integer, parameter :: most = 200
        real(dp) :: a, b, c, fa, fb, fc, fx(values), part, nearest, xi, phi
        integer :: i

        b = from
        a = to
        fx = f%at(b)
        fb = fx(1)
        fx = f%at(a)
        fa = fx(1)
        x = merge(a, b, abs(fa) < abs(fb))
        part = 0.5_dp
        do i = 1, most
            if (.not. min(abs(fa), abs(fb)) > 0.0_dp) return
            nearest = 2.0_dp * epsilon(x) * abs(x) / abs(b - a)
            if (nearest >= 0.5_dp) return
            part = min(max(part, nearest), 1.0_dp - nearest)
            x = a + part * (b - a)
            fx = f%at(x)
            if (fx(1) > 0.0_dp .eqv. fa > 0.0_dp) then
                c = a
                fc = fa
            else
                c = b
                fc = fb
                b = a
                fb = fa
            end if
            a = x
            fa = fx(1)
            x = merge(a, b, abs(fa) < abs(fb))
            xi = (a - b) / (c - b)
            phi = (fa - fb) / (fc - fb)
            part = 0.5_dp
            if (phi**2 >= xi .or. (1.0_dp - phi)**2 >= 1.0_dp - xi) cycle
            part = fa / (fb - fa) * fc / (fb - fc) &
                + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        end do
    end function find_root

end module smooth_function
