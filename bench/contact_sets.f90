!> The contact points that are measured: the same in every run.
module contact_sets
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: contact_set, draw_set, draw_times

    real(dp), parameter :: alpha = 1000.0_dp     !! both contact stiffnesses [F/L^3]
    real(dp), parameter :: mu_s = 0.4_dp, mu_k = 0.2_dp

    !> Constants of the law for `friction_update`.
    real(dp), parameter, public :: props(8) = [1.0_dp, alpha, alpha, mu_s, mu_k, 10.0_dp, 10.0_dp, &
        1000.0_dp]

    real(dp), parameter, public :: time_step = 1.0e-3_dp   !! where all points share one [T]

    !> Points, component-major: (n, ...).
    type :: contact_set
        character(len=:), allocatable :: name
        integer :: increments = 1               !! how often `du` is applied
        real(dp), allocatable :: du(:, :)       !! (n, 3) normal, tangential 1 and 2 [L]
        real(dp), allocatable :: statev(:, :)   !! (n, 8) at the start
    end type contact_set

contains

    !> Draws `n` points.
    !>
    !> `random` and `wide`: on the subloading surface, pushed on within half a radian of their
    !> elastic displacement by 1e-6 to 1e-4 and by 1e-6 to 1e-1, evenly in the logarithm.
    !> `monotonic`: at rest without tangential load, then pushed 20 times in one direction to twice
    !> the elastic displacement of the static strength.
    subroutine draw_set(name, n, seed, set)
        character(len=*), intent(in) :: name   !! monotonic, random or wide
        integer, intent(in) :: n               !! number of points
        integer, intent(in) :: seed            !! of the draws
        type(contact_set), intent(out) :: set
        integer, parameter :: path_increments = 20
        real(dp), parameter :: two_pi = 8.0_dp * atan(1.0_dp)
        real(dp) :: x(6), mu, pressure, r, angle, turn, reach, push, decades
        logical :: path
        integer :: k

        call seed_draws(seed)
        set%name = name
        allocate (set%du(n, 3), set%statev(n, 8))
        path = name == 'monotonic'
        if (path) set%increments = path_increments
        decades = merge(5.0_dp, 2.0_dp, name == 'wide')
        do k = 1, n
            call random_number(x)
            pressure = 1.0_dp + 99.0_dp * x(1)
            angle = two_pi * x(2)
            if (path) then
                mu = mu_s
                r = 0.0_dp
                turn = angle
                push = 2.0_dp * mu_s * pressure / (alpha * path_increments)
            else
                mu = mu_k + (mu_s - mu_k) * x(3)
                r = 0.05_dp + 0.95_dp * x(4)
                turn = angle + x(5) - 0.5_dp
                push = 10.0_dp**(decades * x(6) - 6.0_dp)
            end if
            reach = r * mu * pressure / alpha
            set%du(k, :) = [0.0_dp, push * cos(turn), push * sin(turn)]
            set%statev(k, :) = [1.0_dp, -pressure / alpha, reach * cos(angle), reach * sin(angle), &
                mu, r, 0.0_dp, 0.0_dp]
        end do
    end subroutine draw_set

    !> Increments of time from 1e-6 to 1e-2, evenly in the logarithm.
    subroutine draw_times(seed, dt)
        integer, intent(in) :: seed
        real(dp), intent(out) :: dt(:)   !! [T]

        call seed_draws(seed)
        call random_number(dt)
        dt = 10.0_dp**(4.0_dp * dt - 6.0_dp)
    end subroutine draw_times

    subroutine seed_draws(seed)
        integer, intent(in) :: seed
        integer, allocatable :: put(:)
        integer :: n, i

        call random_seed(size=n)
        allocate (put(n))
        put = [(seed + 7919 * i, i = 1, n)]
        call random_seed(put=put)
    end subroutine seed_draws

end module contact_sets
