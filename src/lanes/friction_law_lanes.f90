!> The lanes of a law, by its number: all that the contact of a block (module friction_batch_kernel)
!> knows of laws.
module friction_law_lanes
    use, intrinsic :: iso_fortran_env, only : wp => real64
    use friction_coulomb_lanes, only : rest_coulomb, slide_coulomb
    use friction_lane_block, only : block_task, lane_ageing, lane_cotangent, lane_coulomb, &
        lane_exact_rate, lane_flash_heating, lane_healing, lane_pressed_ageing, &
        lane_pressed_slip_law, lane_reciprocal, lane_slip_weakening, &
        lane_static_kinetic, lane_subloading, lanes, n_constants, rest_block, slide_block
    use friction_rate_state_lanes, only : rest_rate_state, slide_rate_state, state_rate_state
    use friction_slip_weakening_lanes, only : rest_slip_weakening, slide_slip_weakening, &
        state_slip_weakening
    use friction_static_kinetic_lanes, only : rest_static_kinetic, slide_static_kinetic, &
        state_static_kinetic
    use friction_subloading_exact_lanes, only : exact_coefficients_after, rest_subloading_exact, &
        slide_subloading_exact
    use friction_subloading_general_lanes, only : slide_subloading_general, &
        state_subloading_general
    use friction_subloading_lanes, only : coefficients_after, rest_subloading, slide_subloading, &
        state_subloading
    implicit none
    private

    !> Families of kinds that share their lanes: the only place that says which belong together.
    integer, parameter :: first_general = lane_cotangent, last_general = lane_reciprocal, &
        first_weakening = lane_slip_weakening, last_weakening = lane_healing, &
        first_rate_state = lane_ageing, last_rate_state = lane_flash_heating

    public :: counts_pressure_before, find_coefficients, follows_path, follows_rate, mobilises, &
        rest_law, slide_law, state_of_law

contains

    !> An increment without slip.
    pure subroutine rest_law(task, constants, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(rest_block), intent(inout) :: block

        select case (task%kind)
        case (lane_subloading, first_general:last_general)
            call rest_subloading(constants, task%dt, block)
        case (lane_exact_rate)
            call rest_subloading_exact(constants, task%dt, block)
        case (lane_coulomb)
            call rest_coulomb(constants, block)
        case (lane_static_kinetic)
            call rest_static_kinetic(constants, block)
        case (first_rate_state:last_rate_state)
            call rest_rate_state(task%kind, constants, task%dt, block)
        case (first_weakening:last_weakening)
            call rest_slip_weakening(constants, task%kind == lane_healing, task%dt, block)
        case default
            block%valid = -1.0_wp   ! no lanes
        end select
    end subroutine rest_law

    !> The first equilibrium of points that slide.
    pure subroutine slide_law(task, constants, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block

        select case (task%kind)
        case (lane_subloading)
            call slide_subloading(constants, task%dt, block)
        case (lane_exact_rate)
            call slide_subloading_exact(constants, task%dt, block)
        case (first_general:last_general)
            call slide_subloading_general(constants, task%kind == lane_cotangent, task%dt, block)
        case (lane_coulomb)
            call slide_coulomb(constants, block)
        case (lane_static_kinetic)
            call slide_static_kinetic(constants, task%dt, block)
        case (first_rate_state:last_rate_state)
            call slide_rate_state(task%kind, constants, task%dt, block)
        case (first_weakening:last_weakening)
            call slide_slip_weakening(constants, task%kind == lane_healing, task%dt, block)
        case default
            block%left = 1.0_wp
        end select
    end subroutine slide_law

    !> mu and r after a given slip.
    pure subroutine state_of_law(task, constants, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end, r_end, left

        select case (task%kind)
        case (lane_subloading)
            call state_subloading(constants, task%dt, block)
        case (first_general:last_general)
            call state_subloading_general(constants, task%kind == lane_cotangent, task%dt, block)
        case (lane_static_kinetic)
            call state_static_kinetic(constants, task%dt, block)
        case (first_rate_state:last_rate_state)
            call state_rate_state(task%kind, constants, task%dt, block)
        case (first_weakening:last_weakening)
            call state_slip_weakening(constants, task%kind == lane_healing, task%dt, block)
        case (lane_coulomb)
            continue   ! has no variables
        case default
            block%left = 1.0_wp   ! one by one
        end select
    end subroutine state_of_law

    !> Coefficients after the slips that were found, of a law that `mobilises`.
    pure subroutine find_coefficients(task, constants, block)
        type(block_task), intent(in) :: task
        real(wp), intent(in) :: constants(lanes, n_constants)
        type(slide_block), intent(inout) :: block   !! in: slip, out: mu_end

        if (task%kind == lane_exact_rate) then
            call exact_coefficients_after(constants, task%dt, block)
        else
            call coefficients_after(constants, task%dt, block)
        end if
    end subroutine find_coefficients

    !> Does a law carry a share of its strength (`mobilises_cohesion` of the law)?
    pure function mobilises(task)
        type(block_task), intent(in) :: task
        logical :: mobilises

        mobilises = task%kind >= lane_subloading .and. task%kind <= last_general
    end function mobilises

    !> Does the coefficient in the state follow from the slip rate?
    pure function follows_rate(task)
        type(block_task), intent(in) :: task
        logical :: follows_rate

        follows_rate = task%kind >= first_rate_state .and. task%kind <= last_rate_state
    end function follows_rate

    !> Does a law follow the path within an increment (`follows_path` of the law)?
    pure function follows_path(task)
        type(block_task), intent(in) :: task
        logical :: follows_path

        follows_path = task%kind == lane_exact_rate
    end function follows_path

    !> Does its state depend on how the pressure changes?
    pure function counts_pressure_before(task) result(counts)
        type(block_task), intent(in) :: task
        logical :: counts

        counts = task%kind == lane_pressed_ageing .or. task%kind == lane_pressed_slip_law
    end function counts_pressure_before

end module friction_law_lanes
