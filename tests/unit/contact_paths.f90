!> Paths that a host takes a contact point along, the same for every adapter.
module contact_paths
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: path_increment, path_law, rotation

    integer, parameter, public :: path_length = 60
    real(dp), parameter, public :: path_props(9) = [1.0_dp, 1.0e3_dp, 8.0e2_dp, 0.45_dp, 0.25_dp, &
        8.0_dp, 0.2_dp, 60.0_dp, 0.4_dp]

    integer, parameter, public :: path_laws = 5

contains

    !> Constants of each law.
    pure function path_law(law) result(props)
        integer, intent(in) :: law   !! number of the law, 1 to path_laws
        real(dp), allocatable :: props(:)

        props = path_props(1:3)
        props(1) = law
        select case (law)
        case (2)
            props = [props, 0.4_dp]
        case (3)
            props = [props, 0.45_dp, 0.25_dp, 20.0_dp]
        case (4)
            props = [props, 0.01_dp, 0.012_dp, 1.0e-3_dp, 1.0e-2_dp, 0.4_dp]
        case (5)
            props = [props, 0.45_dp, 0.25_dp, 1.0e-3_dp]
        case default
            props = path_props
        end select
    end function path_law

    !> Pressed, sheared, reversed, unloaded, re-stuck, opened, closed and sheared again; differs a
    !> little from point to point. Normal displacement > 0 opens.
    pure subroutine path_increment(point, k, du, dt)
        integer, intent(in) :: point   !! which point
        integer, intent(in) :: k       !! which increment, 1 to path_length
        real(dp), intent(out) :: du(3) !! normal, tangential 1 and 2
        real(dp), intent(out) :: dt
        real(dp) :: bit

        bit = 1.0e-5_dp * mod(point, 7)
        dt = 1.0e-2_dp * (1 + mod(k, 3))
        select case (k)
        case (1)
            du = [-2.0e-3_dp - bit, 0.0_dp, 0.0_dp]
        case (2:15)
            du = [-1.0e-5_dp, 4.0e-4_dp, 1.0e-4_dp + bit]
        case (16:25)
            du = [2.0e-5_dp, -3.0e-4_dp, 2.0e-4_dp]
        case (26:30)
            du = 0.0_dp
        case (31:33)
            du = [0.0_dp, 1.0e-5_dp, 1.0e-5_dp]
        case (34:35)
            du = [3.0e-3_dp, 5.0e-4_dp, -1.0e-4_dp]
        case (36)
            du = [-6.0e-3_dp, 4.0e-4_dp, 2.0e-4_dp]
        case default
            du = [1.0e-6_dp, 2.0e-4_dp, -5.0e-4_dp + bit]
        end select
    end subroutine path_increment

    !> Rotation in the plane by an angle.
    pure function rotation(angle) result(q)
        real(dp), intent(in) :: angle
        real(dp) :: q(2, 2)

        q = reshape([cos(angle), sin(angle), -sin(angle), cos(angle)], [2, 2])
    end function rotation

end module contact_paths
