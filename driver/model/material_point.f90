!> One contact point under mixed control: in each direction either the relative displacement or the
!> traction is prescribed. Displacements that follow from tractions are found by Newton's method
!> on the consistent tangent, an unsymmetric system of one to three unknowns (LAPACK).
module material_point
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : friction_message, friction_no_convergence, &
        friction_snap_back, friction_update, prop_alpha_n, prop_alpha_t, statev_mu, statev_size, &
        statev_u_n
    use lapack_interface, only : dgesv
    use number_text, only : rounded_text
    implicit none
    private

    public :: contact_point, load_report, virgin_point

    type :: contact_point
        real(dp), allocatable :: props(:)         !! constants of the friction routine
        real(dp), allocatable :: u(:)             !! relative displacement, normal first [L]
        real(dp), allocatable :: traction(:)      !! transmitted [F/L^2]
        real(dp), allocatable :: tangent(:, :)    !! dT/du in the last (part of an) increment
                                                  !! [F/L^3]
        real(dp) :: statev(statev_size) = 0.0_dp
        real(dp) :: work = 0.0_dp                 !! done on the point, per area [F/L]
    contains
        procedure :: load, stored
    end type contact_point

    !> How an increment went.
    type :: load_report
        character(len=:), allocatable :: failure   !! why it could not be carried; or empty
        real(dp) :: done = 0.0_dp                  !! part of the increment, 0 to 1
        integer :: iterations = 0                  !! linear systems solved
        integer :: cuts = 0                        !! parts that had to be halved
        logical :: snap_back = .false.             !! several equilibria were seen
    end type load_report

    real(dp), parameter :: tolerance = 1.0e-12_dp     !! of a traction, relative to the largest
    integer, parameter :: max_iterations = 50
    integer, parameter :: max_halvings = 12           !! of a Newton step, and of an increment

contains

    !> A point that nothing has touched, at zero displacement.
    pure subroutine virgin_point(props, ndir, point, status)
        real(dp), intent(in) :: props(:)   !! constants of the friction routine
        integer, intent(in) :: ndir        !! directions, 2 or 3
        type(contact_point), intent(out) :: point
        integer, intent(out) :: status     !! of the friction routine
        real(dp) :: nothing(ndir)

        point%props = props
        allocate (point%u(ndir), point%traction(ndir), source=0.0_dp)
        allocate (point%tangent(ndir, ndir), source=0.0_dp)
        nothing = 0.0_dp
        call friction_update(nothing, 0.0_dp, props, point%statev, point%traction, point%tangent, &
            status)
    end subroutine virgin_point

    !> Moves the prescribed values linearly to `to` during `dt`. Where equilibrium is not found, the
    !> increment is taken in parts; the point is left at the last one that succeeded.
    subroutine load(self, by_traction, from, to, dt, report)
        class(contact_point), intent(inout) :: self
        logical, intent(in) :: by_traction(:)   !! the direction's traction is prescribed, not its
                                                !! displacement
        real(dp), intent(in) :: from(:), to(:)  !! prescribed values: start, end [F/L^2] or [L]
        real(dp), intent(in) :: dt              !! duration, >= 0 [T]
        type(load_report), intent(out) :: report
        type(contact_point) :: new
        real(dp) :: part, values(size(to))
        integer :: status

        report%failure = ''
        part = 1.0_dp
        do while (report%done < 1.0_dp)
            values = to
            if (report%done + part < 1.0_dp) values = from + (report%done + part) * (to - from)
            call find_equilibrium(self, by_traction, values, part * dt, new, report%iterations, &
                status)
            if (status >= 0) then
                report%snap_back = report%snap_back .or. status == friction_snap_back
                call add_work(self, new)
                self%u = new%u
                self%traction = new%traction
                self%tangent = new%tangent
                self%statev = new%statev
                self%work = new%work
                report%done = report%done + part
                part = min(2.0_dp * part, 1.0_dp - report%done)
            else if (any(by_traction) .and. part > 0.5_dp**max_halvings) then
                part = 0.5_dp * part
                report%cuts = report%cuts + 1
            else
                report%failure = reason(self, by_traction, values, status)
                return
            end if
        end do
    end subroutine load

    !> The point at the end of (part of) an increment. Newton's method starts from the elastic
    !> answer: traction grows ever more slowly with displacement, so it comes from the side of less
    !> slip.
    subroutine find_equilibrium(old, by_traction, values, dt, new, iterations, status)
        type(contact_point), intent(in) :: old
        logical, intent(in) :: by_traction(:)
        real(dp), intent(in) :: values(:)          !! prescribed at the end
        real(dp), intent(in) :: dt                 !! [T]
        type(contact_point), intent(out) :: new
        integer, intent(inout) :: iterations       !! counts on
        integer, intent(out) :: status             !! of the friction routine, or no convergence
        real(dp) :: du(size(values)), start(size(values)), correction(size(values))
        real(dp) :: residual(size(values)), norm, norm_before
        integer :: iteration, halving
        logical :: solved

        new = old
        du = values - old%u
        where (by_traction) du = elastic_answer(old, values)
        call evaluate()
        do iteration = 1, max_iterations
            if (status < 0) return
            if (norm <= allowed()) return
            call solve(new%tangent, by_traction, residual, correction, solved)
            if (.not. solved) exit
            iterations = iterations + 1
            start = du
            norm_before = norm
            do halving = 0, max_halvings
                du = start + correction / 2**halving
                call evaluate()
                if (status >= 0 .and. norm < norm_before) exit
            end do
            if (status < 0 .or. norm >= norm_before) exit
        end do
        status = friction_no_convergence

    contains

        subroutine evaluate()
            new%statev = old%statev
            call friction_update(du, dt, old%props, new%statev, new%traction, new%tangent, status)
            new%u = old%u + du
            where (.not. by_traction) new%u = values
            residual = 0.0_dp
            where (by_traction) residual = values - new%traction
            norm = maxval(abs(residual))
        end subroutine evaluate

        !> A residual this small is zero: relative to the tractions, and as displacements resolve.
        pure real(dp) function allowed() result(zero)
            zero = tolerance * max(maxval(abs(new%traction)), maxval(abs(old%traction)), &
                maxval(abs(values), mask=by_traction)) &
                + 4.0_dp * epsilon(zero) * maxval(old%props(prop_alpha_n:prop_alpha_t)) &
                * maxval(abs(du))
        end function allowed

    end subroutine find_equilibrium

    !> Displacement increments that would carry the prescribed tractions without slip. In the normal
    !> direction that is exact: a spring without tension.
    pure function elastic_answer(old, values) result(du)
        type(contact_point), intent(in) :: old
        real(dp), intent(in) :: values(:)
        real(dp) :: du(size(values))

        du(2:) = (values(2:) - old%traction(2:)) / old%props(prop_alpha_t)
        du(1) = min(values(1), 0.0_dp) / old%props(prop_alpha_n) - old%statev(statev_u_n)
        if (values(1) >= 0.0_dp) du(1) = max(du(1), 0.0_dp)   ! an open point stays where it is
    end function elastic_answer

    !> Newton's correction of the displacements that are free.
    pure subroutine solve(tangent, free, residual, correction, solved)
        real(dp), intent(in) :: tangent(:, :), residual(:)
        logical, intent(in) :: free(:)
        real(dp), intent(out) :: correction(:)   !! zero where the displacement is prescribed
        logical, intent(out) :: solved
        integer, allocatable :: at(:)
        real(dp), allocatable :: matrix(:, :), right(:)
        integer :: pivots(size(free)), info, i

        at = pack([(i, i = 1, size(free))], free)
        matrix = tangent(at, at)
        right = residual(at)
        call dgesv(size(at), 1, matrix, size(at), pivots, right, size(at), info)
        solved = info == 0
        correction = 0.0_dp
        if (solved) correction(at) = right
    end subroutine solve

    !> Adds the work by the mean traction over the part of the increment in contact.
    pure subroutine add_work(old, new)
        type(contact_point), intent(in) :: old
        type(contact_point), intent(inout) :: new
        real(dp) :: u_old, u_new, share

        u_old = old%statev(statev_u_n)
        u_new = new%statev(statev_u_n)
        share = 1.0_dp
        if (u_old > 0.0_dp .and. u_new < 0.0_dp) share = u_new / (u_new - u_old)
        if (u_old < 0.0_dp .and. u_new > 0.0_dp) share = u_old / (u_old - u_new)
        new%work = old%work + share * 0.5_dp * dot_product(old%traction + new%traction, &
            new%u - old%u)
    end subroutine add_work

    !> Elastic energy per area [F/L].
    pure real(dp) function stored(self) result(energy)
        class(contact_point), intent(in) :: self

        energy = 0.5_dp * (self%traction(1)**2 / self%props(prop_alpha_n) &
            + sum(self%traction(2:)**2) / self%props(prop_alpha_t))
    end function stored

    !> Why could the point not be loaded any further?
    pure function reason(point, by_traction, values, status) result(text)
        type(contact_point), intent(in) :: point   !! at the last equilibrium
        logical, intent(in) :: by_traction(:)
        real(dp), intent(in) :: values(:)          !! that could not be reached
        integer, intent(in) :: status
        character(len=:), allocatable :: text
        character(len=200) :: buffer

        if (by_traction(1) .and. values(1) > 0.0_dp) then
            buffer = 'a contact carries no tension: t_n = ' // rounded_text(values(1), 12, 5)
        else if (any(by_traction(2:)) .and. .not. point%traction(1) < 0.0_dp) then
            buffer = 'an open contact carries no tangential traction'
        else if (any(by_traction(2:)) .and. status == friction_no_convergence) then
            buffer = 'the tangential traction cannot be carried: beyond ' &
                // rounded_text(norm2(point%traction(2:)), 12, 5) // ' (mu |t_n| = ' &
                // rounded_text(-point%statev(statev_mu) * point%traction(1), 12, 5) &
                // ') the contact gives way'
        else
            buffer = friction_message(status)
        end if
        text = trim(buffer)
    end function reason

end module material_point
