!> What the vector lanes of all laws share: blocks of contact points, component by component.
!>
!> The modules of this folder are compiled once for each vector instruction set, under other names,
!> together with the laws' cores (src/CMakeLists.txt): they use nothing else, so that the copies
!> share nothing. No floating-point exception but inexact and underflow: a lane that a formula is
!> not
!> meant for gets numbers that harm nobody.
module friction_lane_block
    use, intrinsic :: iso_fortran_env, only : wp => real64
    implicit none
    private

    integer, parameter, public :: lanes = 128   !! points of a block: its scratch data stay in cache
    integer, parameter, public :: widest = 8    !! lanes of the widest vectors

    !> Columns of the constants of a block's points.
    integer, parameter, public :: c_alpha_n = 1   !! [F/L^3]
    integer, parameter, public :: c_alpha_t = 2   !! [F/L^3]
    integer, parameter, public :: c_own = 3       !! first of the law's own, as in `props`
    integer, parameter, public :: n_own = 6
    integer, parameter, public :: c_mu_0 = 9      !! friction coefficient of a virgin point [-]
    integer, parameter, public :: c_r_0 = 10      !! its internal variable
    integer, parameter, public :: c_cap = 11      !! shear cap; without one `no_cap` [F/L^2]
    integer, parameter, public :: c_squeeze = 12  !! mu_1/mu_2 of orthotropic friction [-]
    integer, parameter, public :: n_constants = 12
    real(wp), parameter, public :: no_cap = 1.0e90_wp
    real(wp), parameter, public :: least_ratio = 1.0e-100_wp   !! of module friction_law

    !> Laws with lanes.
    integer, parameter, public :: lane_none = 0, lane_subloading = 1, lane_exact_rate = 2, &
        lane_cotangent = 3, lane_reciprocal = 4, lane_coulomb = 5, lane_static_kinetic = 6, &
        lane_ageing = 7, lane_slip_law = 8, lane_slip_weakening = 9

    !> An increment without slip.
    type, public :: rest_block
        real(wp) :: traction(lanes)    !! in: carried elastically, 0 in an open contact [F/L^2]
        real(wp) :: pressure(lanes)    !! in: 0 in an open contact [F/L^2]
        real(wp) :: mu(lanes), r(lanes)   !! in: at the start of the increment
        real(wp) :: mu_rest(lanes), r_rest(lanes)   !! out: at its end, if nothing slips
        real(wp) :: strength(lanes)    !! out: traction at which slip starts [F/L^2]
        real(wp) :: valid(lanes)       !! out: below 0 where the state is out of its range
    end type rest_block

    !> Points that slide.
    type, public :: slide_block
        integer :: n                   !! how many, a multiple of the widest vector
        real(wp) :: trial(lanes)       !! in: tangential traction without slip [F/L^2]
        real(wp) :: stiffness(lanes)   !! in: tangential stiffness [F/L^3]
        real(wp) :: pressure(lanes)    !! in: > 0 [F/L^2]
        real(wp) :: mu(lanes), r(lanes)   !! in: at the start of the increment
        real(wp) :: mu_rest(lanes)     !! in: at its end, if nothing slips
        real(wp) :: slip(lanes)        !! out [L]
        real(wp) :: mu_end(lanes), r_end(lanes)   !! out: at the end of the increment
        real(wp) :: resistance(lanes)  !! out [F/L^2]
        real(wp) :: d_slip(lanes)      !! out: d(resistance)/d(slip) [F/L^3]
        real(wp) :: d_pressure(lanes)  !! out: d(resistance)/d(pressure) [-]
        real(wp) :: left(lanes)        !! out: above 0 where the routine for one point is needed:
                                       !! several equilibria are possible, or none was found
    end type slide_block

end module friction_lane_block
