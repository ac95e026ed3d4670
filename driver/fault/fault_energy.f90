!> The energy of a fault. With d = s - V_p t the slip deficit and tau_e = tau_0 + K d the elastic
!> traction, which friction T and radiation damping share, tau_e = T + eta V,
!>
!>     V_p int tau_e dt = [-1/2 d (tau_e + tau_0)] + int T V dt + int eta V^2 dt,
!>
!> summed over the area: the work of loading from afar is the change of elastic energy, what
!> friction dissipates and what is radiated. The first term on the right is exact at all times; the
!> integrals over time are the steps' own, so that the balance is open by their error.
module fault_energy
    use, intrinsic :: iso_fortran_env, only : dp => real64
    implicit none
    private

    public :: energies, row_powers, power_loading, power_radiated, power_slip, powers

    integer, parameter :: powers = 3   !! of a row, per area; the loading's without V_p
    integer, parameter :: power_loading = 1, power_slip = 2, power_radiated = 3

    !> [F L], in antiplane strain per length [F]
    type :: energies
        real(dp) :: loading = 0.0_dp      !! work so far
        real(dp) :: dissipated = 0.0_dp   !! by friction so far
        real(dp) :: radiated = 0.0_dp     !! so far
        real(dp) :: elastic = 0.0_dp      !! change since the start
    contains
        procedure :: unbalanced
    end type energies

contains

    !> What the balance is open by, over the most that has passed through it.
    pure real(dp) function unbalanced(self) result(part)
        class(energies), intent(in) :: self

        part = abs(self%loading - self%elastic - self%dissipated - self%radiated) &
            / max(abs(self%loading), abs(self%elastic), self%dissipated + self%radiated, &
            tiny(1.0_dp))
    end function unbalanced

    !> Sums over each row of cells, always in the same order.
    pure subroutine row_powers(nx, rows, elastic, rate, damping, sums)
        integer, intent(in) :: nx, rows
        real(dp), intent(in) :: elastic(nx, rows)   !! traction [F/L^2]
        real(dp), intent(in) :: rate(nx, rows)      !! of slip [L/T]
        real(dp), intent(in) :: damping             !! [F T/L^3]
        real(dp), intent(out) :: sums(rows, powers)
        integer, parameter :: lanes = 8
        real(dp) :: part(lanes, powers)
        integer :: i, k, n

        if (nx == 1) then
            sums(:, power_loading) = elastic(1, :)
            sums(:, power_radiated) = damping * rate(1, :)**2
            sums(:, power_slip) = elastic(1, :) * rate(1, :) - sums(:, power_radiated)
            return
        end if
        do k = 1, rows
            part = 0.0_dp
            do i = 1, nx, lanes
                n = min(lanes, nx - i + 1)
                part(:n, 1) = part(:n, 1) + elastic(i:i + n - 1, k)
                part(:n, 2) = part(:n, 2) + elastic(i:i + n - 1, k) * rate(i:i + n - 1, k)
                part(:n, 3) = part(:n, 3) + rate(i:i + n - 1, k)**2
            end do
            sums(k, power_loading) = sum(part(:, 1))
            sums(k, power_radiated) = damping * sum(part(:, 3))
            sums(k, power_slip) = sum(part(:, 2)) - sums(k, power_radiated)
        end do
    end subroutine row_powers

end module fault_energy
